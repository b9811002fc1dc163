// SPDX-License-Identifier: BSD-3-Clause
// An OpenGL context without window, display server or graphics card. Include in .cpp files only.
#pragma once

#include <memory>
#include <string>

#include "render/gl_api.h"

namespace cprsim {

/// Current in the thread that created it until another one is made there.
class EglContext {
 public:
  /// Tries the surfaceless platform, then every EGL device, then the default display.
  /// @return nullptr if none gives OpenGL 3.3 core; why_not then tells what was tried and what to
  /// install
  static std::unique_ptr<EglContext> create(std::string& why_not);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  /// In the thread that created it, before any GL function is called.
  void make_current() const;

  const Gl& gl() const { return gl_; }

  std::string device() const { return device_; }  ///< GL_RENDERER

 private:
  struct Egl;
  EglContext();
  std::unique_ptr<Egl> egl_;
  Gl gl_;
  std::string device_;
};

}  // namespace cprsim
