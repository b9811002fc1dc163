// SPDX-License-Identifier: BSD-3-Clause
#include "render/egl_context.h"

#include <dlfcn.h>

#define EGL_NO_X11
#define MESA_EGL_NO_X11_HEADERS
#define EGL_EGL_PROTOTYPES 0
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace cprsim {

namespace {

const char* const kInstall =
    "pictures need OpenGL without a display: install the Debian packages libegl1 libegl-mesa0 "
    "libgl1-mesa-dri";

std::string egl_error_name(EGLint code) {
  switch (code) {
    case EGL_SUCCESS:
      return "no error given";
    case EGL_NOT_INITIALIZED:
      return "EGL_NOT_INITIALIZED";
    case EGL_BAD_ALLOC:
      return "EGL_BAD_ALLOC";
    case EGL_BAD_ATTRIBUTE:
      return "EGL_BAD_ATTRIBUTE";
    case EGL_BAD_CONFIG:
      return "EGL_BAD_CONFIG";
    case EGL_BAD_DISPLAY:
      return "EGL_BAD_DISPLAY";
    case EGL_BAD_MATCH:
      return "EGL_BAD_MATCH";
    case EGL_BAD_PARAMETER:
      return "EGL_BAD_PARAMETER";
    default:
      break;
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "EGL error 0x%04x", static_cast<unsigned>(code));
  return text.data();
}

}  // namespace

struct EglContext::Egl {
  void* library = nullptr;
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;

  PFNEGLGETPROCADDRESSPROC GetProcAddress = nullptr;
  PFNEGLGETDISPLAYPROC GetDisplay = nullptr;
  PFNEGLINITIALIZEPROC Initialize = nullptr;
  PFNEGLBINDAPIPROC BindAPI = nullptr;
  PFNEGLCREATECONTEXTPROC CreateContext = nullptr;
  PFNEGLDESTROYCONTEXTPROC DestroyContext = nullptr;
  PFNEGLMAKECURRENTPROC MakeCurrent = nullptr;
  PFNEGLGETCURRENTCONTEXTPROC GetCurrentContext = nullptr;
  PFNEGLGETERRORPROC GetError = nullptr;
  PFNEGLQUERYSTRINGPROC QueryString = nullptr;

  bool load(std::string& why_not);
  bool start(EGLDisplay candidate, const std::string& way, std::string& tried);
  bool start_any(std::string& tried);
  void stop();

  template <class F>
  bool symbol(F& function, const char* name) {
    function = reinterpret_cast<F>(dlsym(library, name));
    return function != nullptr;
  }

  template <class F>
  F extension(const char* name) const {
    return reinterpret_cast<F>(GetProcAddress(name));
  }
};

bool EglContext::Egl::load(std::string& why_not) {
  library = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* reason = dlerror();
    why_not = std::string(kInstall) + " (" + (reason ? reason : "libEGL.so.1 not found") + ")";
    return false;
  }
  const bool complete =
      symbol(GetProcAddress, "eglGetProcAddress") && symbol(GetDisplay, "eglGetDisplay") &&
      symbol(Initialize, "eglInitialize") && symbol(BindAPI, "eglBindAPI") &&
      symbol(CreateContext, "eglCreateContext") && symbol(DestroyContext, "eglDestroyContext") &&
      symbol(MakeCurrent, "eglMakeCurrent") && symbol(GetCurrentContext, "eglGetCurrentContext") &&
      symbol(GetError, "eglGetError") && symbol(QueryString, "eglQueryString");
  if (!complete) why_not = std::string(kInstall) + " (libEGL.so.1 lacks functions of EGL 1.4)";
  return complete;
}

bool EglContext::Egl::start(EGLDisplay candidate, const std::string& way, std::string& tried) {
  const auto fail = [&](const char* what) {
    tried += (tried.empty() ? "" : "; ") + way + ": " + what + " " + egl_error_name(GetError());
    return false;
  };
  if (candidate == EGL_NO_DISPLAY) return fail("no display,");
  if (!Initialize(candidate, nullptr, nullptr)) return fail("eglInitialize failed,");
  // no surface and no config are needed: everything is drawn into framebuffer objects
  const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION,
                           3,
                           EGL_CONTEXT_MINOR_VERSION,
                           3,
                           EGL_CONTEXT_OPENGL_PROFILE_MASK,
                           EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                           EGL_NONE};
  if (!BindAPI(EGL_OPENGL_API)) {
    fail("no desktop OpenGL,");
  } else {
    context = CreateContext(candidate, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted);
    if (context == EGL_NO_CONTEXT) {
      fail("no OpenGL 3.3 core context,");
    } else if (!MakeCurrent(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
      fail("eglMakeCurrent failed,");
      DestroyContext(candidate, context);
      context = EGL_NO_CONTEXT;
    } else {
      display = candidate;
      return true;
    }
  }
  return false;
}

bool EglContext::Egl::start_any(std::string& tried) {
  const char* text = QueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const std::string extensions = text ? text : "";
  const auto platform_display =
      extension<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  const bool surfaceless = extensions.find("EGL_MESA_platform_surfaceless") != std::string::npos;
  if (platform_display && surfaceless &&
      start(platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr),
            "surfaceless", tried)) {
    return true;
  }
  const auto query_devices = extension<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
  if (platform_display && query_devices) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (!query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      EGLDisplay shown =
          platform_display(EGL_PLATFORM_DEVICE_EXT, devices[static_cast<std::size_t>(i)], nullptr);
      if (start(shown, "device " + std::to_string(i), tried)) return true;
    }
  }
  return start(GetDisplay(EGL_DEFAULT_DISPLAY), "default display", tried);
}

void EglContext::Egl::stop() {
  if (display != EGL_NO_DISPLAY) {
    if (GetCurrentContext() == context) {
      MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    }
    DestroyContext(display, context);
  }
  // the display is not terminated: every context of this process shares it. The library stays
  // loaded: drivers leave threads and exit handlers behind
}

EglContext::EglContext() : egl_(std::make_unique<Egl>()) {}

EglContext::~EglContext() {
  if (egl_->library) egl_->stop();
}

void EglContext::make_current() const {
  if (egl_->GetCurrentContext() == egl_->context) return;
  egl_->MakeCurrent(egl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, egl_->context);
}

std::unique_ptr<EglContext> EglContext::create(std::string& why_not) {
  std::unique_ptr<EglContext> made(new EglContext);
  if (!made->egl_->load(why_not)) return nullptr;
  std::string tried;
  if (!made->egl_->start_any(tried)) {
    why_not = std::string(kInstall) + " (tried " + tried + ")";
    return nullptr;
  }
  std::string missing;
#define CPRSIM_GL_FETCH(name, type)                                      \
  made->gl_.name = made->egl_->extension<PFNGL##type##PROC>("gl" #name); \
  if (made->gl_.name == nullptr && missing.empty()) missing = "gl" #name;
  CPRSIM_GL_FUNCTIONS(CPRSIM_GL_FETCH)
#undef CPRSIM_GL_FETCH
  if (!missing.empty()) {
    why_not = std::string(kInstall) + " (this OpenGL lacks " + missing + ")";
    return nullptr;
  }
  const GLubyte* name = made->gl_.GetString(GL_RENDERER);
  made->device_ = name ? reinterpret_cast<const char*>(name) : "unknown OpenGL";
  return made;
}

}  // namespace cprsim
