// The handler does only what POSIX allows in one: write and _exit. Drivers clean up after a process by themselves.
#include "tool/interruption.h"

#include <unistd.h>

#include <array>
#include <csignal>
#include <string_view>

namespace mesograin::tool {
namespace {

constexpr std::array ending_signals{SIGINT, SIGTERM, SIGHUP};

void leave(int signal) {
  constexpr std::string_view farewell = "\nmesograin-render: interrupted; nothing was written.\n";
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, farewell.data(), farewell.size());
  ::_exit(128 + signal);
}

}  // namespace

void handle_interruptions() {
  for (const int signal : ending_signals) std::signal(signal, leave);
  for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
}

// Ignored, not blocked: any thread of the driver's could take a signal that only this one blocks.
Uninterrupted::Uninterrupted() {
  for (const int signal : ending_signals) std::signal(signal, SIG_IGN);
}

Uninterrupted::~Uninterrupted() { handle_interruptions(); }

}  // namespace mesograin::tool
