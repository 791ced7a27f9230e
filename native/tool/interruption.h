// Ctrl-C ends the tool at once, except while a file is being written, which takes a moment and is then whole.
#pragma once

namespace mesograin::tool {

/// From here on SIGINT, SIGTERM and SIGHUP end the process with 128 + their number (Ctrl-C: 130), and a full disk is
/// an error like any other instead of a signal.
void handle_interruptions();

/// Holds interruptions back while it lives.
class Uninterrupted {
 public:
  Uninterrupted();
  ~Uninterrupted();
  Uninterrupted(const Uninterrupted&) = delete;
  Uninterrupted& operator=(const Uninterrupted&) = delete;
};

}  // namespace mesograin::tool
