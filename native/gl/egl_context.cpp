// Tries EGL devices until one makes a GL 4.5 core context current.
#include "gl/egl_context.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "base/error.h"

namespace mesograin::gl {
namespace {

constexpr int required_major = 4;
constexpr int required_minor = 5;

struct Candidate {
  std::string name;
  EGLDeviceEXT device = nullptr;  // null asks for the surfaceless platform
  bool hardware = false;
};

template <typename Function>
Function load(const char* name) {
  return reinterpret_cast<Function>(eglGetProcAddress(name));
}

bool lists(const char* extensions, const char* extension) {
  return extensions != nullptr && std::strstr(extensions, extension) != nullptr;
}

std::vector<Candidate> find_candidates() {
  std::vector<Candidate> candidates;
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (lists(extensions, "EGL_EXT_device_enumeration") || lists(extensions, "EGL_EXT_device_base")) {
    const auto query_devices = load<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = load<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    EGLint count = 0;
    if (query_devices != nullptr && query_devices(0, nullptr, &count) == EGL_TRUE && count > 0) {
      std::vector<EGLDeviceEXT> devices(count);
      query_devices(count, devices.data(), &count);
      for (EGLint i = 0; i < count; ++i) {
        const char* traits = query_string != nullptr ? query_string(devices[i], EGL_EXTENSIONS) : nullptr;
        candidates.push_back({std::to_string(i), devices[i], !lists(traits, "EGL_MESA_device_software")});
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.hardware > b.hardware; });
  if (lists(extensions, "EGL_MESA_platform_surfaceless")) candidates.push_back({"surfaceless", nullptr, false});
  return candidates;
}

bool wanted(const Candidate& candidate, const std::string& choice) {
  if (choice.empty()) return true;
  if (choice == "hardware") return candidate.hardware;
  if (choice == "software") return !candidate.hardware;
  return candidate.name == choice;
}

struct Attempt {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  std::string failure;
};

// Displays are never terminated: another part of the process may share them.
Attempt try_candidate(const Candidate& candidate) {
  Attempt attempt;
  const auto get_display = load<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
  if (get_display == nullptr) {
    attempt.failure = "eglGetPlatformDisplayEXT is missing";
    return attempt;
  }
  attempt.display = candidate.device != nullptr
                        ? get_display(EGL_PLATFORM_DEVICE_EXT, candidate.device, nullptr)
                        : get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  if (attempt.display == EGL_NO_DISPLAY) {
    attempt.failure = "no display";
    return attempt;
  }
  if (eglInitialize(attempt.display, nullptr, nullptr) != EGL_TRUE) {
    attempt.failure = fmt::format("eglInitialize failed with {:#x}", eglGetError());
    return attempt;
  }
  eglBindAPI(EGL_OPENGL_API);
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               required_major,
                               EGL_CONTEXT_MINOR_VERSION,
                               required_minor,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  attempt.context = eglCreateContext(attempt.display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
  if (attempt.context == EGL_NO_CONTEXT) {
    attempt.failure =
        fmt::format("no OpenGL {}.{} core context ({:#x})", required_major, required_minor, eglGetError());
    return attempt;
  }
  if (eglMakeCurrent(attempt.display, EGL_NO_SURFACE, EGL_NO_SURFACE, attempt.context) != EGL_TRUE) {
    attempt.failure = fmt::format("eglMakeCurrent failed with {:#x}", eglGetError());
    eglDestroyContext(attempt.display, attempt.context);
    attempt.context = EGL_NO_CONTEXT;
  }
  return attempt;
}

// libepoxy ends the process where a library is missing, so it is looked for first.
void require_library(const char* name, const char* remedy) {
  void* library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
  if (library == nullptr)
    throw Error("Rendering needs {}, which cannot be loaded ({}); install {}.", name, dlerror(), remedy);
  dlclose(library);
}

void require_libraries() {
  require_library("libEGL.so.1", "the graphics driver or Mesa's libegl1");
  require_library("libGL.so.1", "the graphics driver or libgl1");
}

std::string describe(GLenum name) {
  const GLubyte* text = glGetString(name);
  return text != nullptr ? reinterpret_cast<const char*>(text) : "unknown";
}

}  // namespace

EglContext::EglContext() {
  require_libraries();
  const char* variable = std::getenv("MESOGRAIN_GL_DEVICE");
  const std::string choice = variable != nullptr ? variable : "";
  for (const Candidate& candidate : find_candidates()) {
    if (!wanted(candidate, choice)) {
      info_.tried.push_back({candidate.name, candidate.hardware, "not asked for"});
      continue;
    }
    const Attempt attempt = try_candidate(candidate);
    if (attempt.context == EGL_NO_CONTEXT) {
      info_.tried.push_back({candidate.name, candidate.hardware, attempt.failure});
      continue;
    }
    display_ = attempt.display;
    context_ = attempt.context;
    info_.chosen = candidate.name;
    info_.renderer = describe(GL_RENDERER);
    info_.version = describe(GL_VERSION);
    info_.hardware = candidate.hardware;
    info_.tried.push_back({candidate.name, candidate.hardware, info_.renderer});
    return;
  }
  std::vector<std::string> log;
  for (const DeviceAttempt& attempt : info_.tried) log.push_back(attempt.device + ": " + attempt.result);
  throw Error(
      "Rendering needs a device with OpenGL {}.{} through EGL{}; tried {}. Install a graphics driver (or Mesa's "
      "libgl1-mesa-dri for software rendering){}.",
      required_major, required_minor, choice.empty() ? "" : " and MESOGRAIN_GL_DEVICE=" + choice,
      log.empty() ? "none, since EGL lists no device" : fmt::format("{}", fmt::join(log, "; ")),
      choice.empty() ? "" : " or unset MESOGRAIN_GL_DEVICE");
}

EglContext::~EglContext() {
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display_, context_);
}

}  // namespace mesograin::gl
