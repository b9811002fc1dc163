// SPDX-License-Identifier: BSD-3-Clause
// The GLSL programs. Colours are decoded from display values by squaring, lit linearly, and encoded
// again by a square root: close to sRGB and far cheaper than a power. Software renderers compute
// both sides of every "if": what is to be saved is left out by a #define instead.
#pragma once

namespace cprsim::shaders {

extern const char* const kVersion;

/// Lights and shadows, shared by the two fragment programs below.
extern const char* const kLighting;

/// Bodies, rods and traces: position 0, normal 1, colour 2.
extern const char* const kObjectVertex;
extern const char* const kObjectFragment;

/// Depth and cover, seen from the key light.
extern const char* const kShadowVertex;
extern const char* const kShadowFragment;

/// One triangle over the whole picture: ground, sky, shadows on them, and the objects over them.
extern const char* const kSceneVertex;
extern const char* const kSceneFragment;

}  // namespace cprsim::shaders
