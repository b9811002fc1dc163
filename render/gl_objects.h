// SPDX-License-Identifier: BSD-3-Clause
// OpenGL objects that free themselves. Include in .cpp files only.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "render/camera.h"
#include "render/gl_api.h"
#include "render/shapes.h"

namespace cprsim {

/// The name of a GL object, deleted with its owner.
class GlName {
 public:
  enum class Kind { kTexture, kFramebuffer, kBuffer, kVertexArray, kSampler };

  GlName() = default;
  GlName(const Gl& gl, Kind kind);

  GlName(GlName&& other) noexcept { *this = std::move(other); }

  GlName& operator=(GlName&& other) noexcept;
  ~GlName();

  operator GLuint() const { return name_; }

 private:
  const Gl* gl_ = nullptr;
  Kind kind_ = Kind::kTexture;
  GLuint name_ = 0;
};

/// A picture on the device. samples > 1: one that can only be drawn to and resolved.
GlName make_texture(const Gl& gl, GLint format, int width, int height, int samples);

/// A framebuffer of the given colour textures (0: none) and a depth texture (0: none). Throws
/// std::runtime_error if the device does not support the combination.
GlName make_target(const Gl& gl, const std::vector<GLuint>& colors, GLuint depth, int samples);

/// A shader program; uniforms are set by name while it is in use.
class Program {
 public:
  /// Throws std::runtime_error with the compiler's log.
  Program(const Gl& gl, const std::string& vertex, const std::string& fragment);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { gl_.UseProgram(name_); }

  void set(const char* name, int value) const;
  void set(const char* name, double value) const;
  void set(const char* name, const Vec2& value) const;
  void set(const char* name, const Vec3& value) const;
  void set(const char* name, const Vec4& value) const;
  void set(const char* name, const Mat4& value) const;
  void set(const char* name, const std::vector<Vec3>& values) const;
  void set(const char* name, const std::vector<Vec4>& values) const;

 private:
  GLint at(const char* name) const { return gl_.GetUniformLocation(name_, name); }

  const Gl& gl_;
  GLuint name_ = 0;
};

/// Triangles on the device.
class Geometry {
 public:
  explicit Geometry(const Gl& gl);

  void upload(const TriMesh& mesh);
  void draw() const;

 private:
  const Gl* gl_;
  GlName array_, vertices_, indices_;
  GLsizei count_ = 0;
};

}  // namespace cprsim
