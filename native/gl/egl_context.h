// Finds a GL 4.5 core context without a window: real devices first, then software, then the surfaceless platform.
#pragma once

#include <string>
#include <vector>

namespace mesograin::gl {

struct DeviceAttempt {
  std::string device;  ///< "0", "1", ... in EGL's order, or "surfaceless"
  bool hardware = false;
  std::string result;  ///< the renderer it offers, or why it was passed over
};

struct DeviceInfo {
  std::string chosen;    ///< as in DeviceAttempt::device
  std::string renderer;  ///< GL_RENDERER
  std::string version;   ///< GL_VERSION
  bool hardware = false;
  std::vector<DeviceAttempt> tried;  ///< in the order tried
};

/// A context that is current on the constructing thread until destruction.
class EglContext {
 public:
  /// Honours the environment variable MESOGRAIN_GL_DEVICE: a device's number, "surfaceless", "hardware" or "software".
  /// Throws Error, listing every device tried, if none offers OpenGL 4.5 core.
  EglContext();
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  const DeviceInfo& info() const { return info_; }

 private:
  void* display_ = nullptr;
  void* context_ = nullptr;
  DeviceInfo info_;
};

}  // namespace mesograin::gl
