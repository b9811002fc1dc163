// SPDX-License-Identifier: BSD-3-Clause
// Pictures as video codecs want them.
#pragma once

#include <cstdint>
#include <vector>

#include "render/image.h"

namespace cprsim {

/// The upper left width × height pixels (even numbers) as planes Y, Cb, Cr of BT.709 in video
/// range, chroma averaged over 2 × 2 pixels.
void to_yuv420(const Image& image, int width, int height, std::vector<std::uint8_t>& planes);

}  // namespace cprsim
