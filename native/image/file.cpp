// Whole files through POSIX calls, each of which is checked: a stream would hide the last error of a full disk.
#include "image/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <utility>

#include "scene/error.h"

namespace mesograin::image {
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
  bool close() { return number_ < 0 || ::close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// A file that is removed unless it was kept.
class TemporaryFile {
 public:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }

  const fs::path& path() const { return path_; }
  void keep() { path_.clear(); }

 private:
  fs::path path_;
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

void write_all(int descriptor, std::string_view bytes, const fs::path& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) throw_not_written(path, errno);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

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

  std::string bytes(static_cast<std::size_t>(status.st_size), '\0');
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

void write_file_atomically(const fs::path& asked_path, std::string_view bytes) {
  if (asked_path.filename().empty()) throw Error("Can't write '{}': a file name is needed.", asked_path.string());
  std::error_code ignored;
  // A link keeps pointing where it does; what it points to is replaced.
  const fs::path path = fs::is_symlink(asked_path, ignored) ? fs::weakly_canonical(asked_path, ignored) : asked_path;
  if (path.empty()) throw Error("Can't write {}: it is a link that points nowhere.", asked_path.string());
  const fs::file_status standing = fs::status(path, ignored);
  if (fs::exists(standing) && !fs::is_regular_file(standing))
    throw Error("Can't write {}: a folder or device of that name is there; choose another name.", path.string());

  static std::atomic<unsigned> count = 0;
  TemporaryFile temporary(path.parent_path() /
                          fmt::format(".{}.{}.tmp", ::getpid(), count.fetch_add(1, std::memory_order_relaxed)));
  Descriptor file(::open(temporary.path().c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.number() < 0) {
    const int error = errno;
    temporary.keep();  // it is not ours
    throw_not_written(path, error);
  }
  write_all(file.number(), bytes, path);
  if (::fsync(file.number()) != 0) throw_not_written(path, errno);
  if (!file.close()) throw_not_written(path, errno);
  if (::rename(temporary.path().c_str(), path.c_str()) != 0) throw_not_written(path, errno);
  temporary.keep();
}

}  // namespace mesograin::image
