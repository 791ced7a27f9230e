// Whole files through POSIX calls, each of which is checked: a stream would hide the last error of a full disk.
#include "base/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include "base/error.h"

namespace mesograin::base {
namespace {

namespace fs = std::filesystem;

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }

  int number() const { return number_; }
  void take(int number) {
    close();
    number_ = number;
  }
  bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

[[noreturn]] void throw_not_written(const fs::path& path, int error) {
  switch (error) {
    case ENOENT:
      throw Error("Can't write {}: its folder does not exist; create the folder or choose another.", path.string());
    case ENOTDIR:
      throw Error("Can't write {}: part of its folder is a file; choose another folder.", path.string());
    case EACCES:
    case EPERM:
    case EROFS:
      throw Error("Can't write {}: its folder is read-only; choose a folder you may write to.", path.string());
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      throw Error(
          "Can't write {}: the disk is full or a size limit is reached; free some space or choose another disk.",
          path.string());
    default:
      throw Error("Can't write {}: {}; choose another place.", path.string(), std::strerror(error));
  }
}

/// What `path` stands for: a link keeps pointing where it does, and what it points to is replaced.
fs::path resolve(const fs::path& path) {
  if (path.filename().empty()) throw Error("Can't write '{}': a file name is needed.", path.string());
  std::error_code ignored;
  fs::path target = fs::is_symlink(path, ignored) ? fs::weakly_canonical(path, ignored) : path;
  if (target.empty()) throw Error("Can't write {}: it is a link that points nowhere.", path.string());
  const fs::file_status standing = fs::status(target, ignored);
  if (fs::exists(standing) && !fs::is_regular_file(standing))
    throw Error("Can't write {}: a folder or device of that name is there; choose another name.", target.string());
  return target;
}

/// A file beside the one that it will become; removed unless it does.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    do {
      path_ = target.parent_path() / fmt::format(".{}.{}.tmp", ::getpid(), ++count_);
      descriptor_.take(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
      // A killed process, or one on another machine that shares the folder, may have a file of this very name.
    } while (descriptor_.number() < 0 && errno == EEXIST);
    if (descriptor_.number() < 0) throw_not_written(target_, errno);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }

  void write(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_.number(), bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw_not_written(target_, errno);
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
  }

  void become_target() {
    if (::fsync(descriptor_.number()) != 0 || !descriptor_.close() || ::rename(path_.c_str(), target_.c_str()) != 0)
      throw_not_written(target_, errno);
    path_.clear();
  }

 private:
  static inline std::atomic<unsigned> count_ = 0;

  fs::path target_;
  fs::path path_;
  Descriptor descriptor_{-1};
};

}  // namespace

std::string read_file(const fs::path& path) {
  // Non-blocking, so that a named pipe is refused instead of waited for.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat status {};
  if (file.number() < 0 || ::fstat(file.number(), &status) != 0) {
    if (errno == ENOENT || errno == ENOTDIR)
      throw Error("There is no file {}; check its name and folder.", path.string());
    throw Error("Can't read {}: {}.", path.string(), std::strerror(errno));
  }
  if (!S_ISREG(status.st_mode)) throw Error("Can't read {}: a file is needed, and it is not one.", path.string());

  std::string bytes;
  try {
    bytes.resize(static_cast<std::size_t>(status.st_size));
  } catch (const std::exception&) {  // too large for memory or for any string
    throw Error("Can't read {}: there is not enough memory for its {} bytes.", path.string(), status.st_size);
  }
  std::size_t filled = 0;
  while (filled < bytes.size()) {
    const ssize_t count = ::read(file.number(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw Error("Can't read {}: {}.", path.string(), std::strerror(errno));
    if (count == 0) break;  // it shrank while it was read
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

void require_writable(const fs::path& path) { const TemporaryFile trial(resolve(path)); }

void write_file_atomically(const fs::path& path, std::string_view bytes) {
  TemporaryFile file(resolve(path));
  file.write(bytes);
  file.become_target();
}

}  // namespace mesograin::base
