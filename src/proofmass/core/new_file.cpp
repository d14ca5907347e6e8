#include "proofmass/core/new_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <random>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace proofmass {
namespace {

namespace fs = std::filesystem;

Error not_written(const std::string& path, int error) {
  return {Errc::unwritable,
          path + ": cannot be written: " + std::generic_category().message(error)};
}

std::optional<struct stat> status_of_path(const std::string& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0) return std::nullopt;
  return found;
}

bool is_one(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

bool is_standard_output(const struct stat& file) {
  struct stat out{};
  return ::fstat(STDOUT_FILENO, &out) == 0 && is_one(out, file);
}

/// The target of a path after all links, whether it exists or not; ELOOP for a cycle of links.
std::string behind_links(std::string path, int& error) {
  constexpr int most_links = 40;
  std::error_code none;
  for (int k = 0; k < most_links; ++k) {
    const fs::path to = fs::read_symlink(path, none);
    if (none) return path;
    path = to.is_absolute() ? to.string() : (fs::path(path).parent_path() / to).string();
  }
  error = ELOOP;
  return path;
}

/// Six unpredictable letters.
std::string random_letters() {
  constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz0123456789";
  std::random_device source;
  std::uniform_int_distribution<std::size_t> any(0, letters.size() - 1);
  std::string out(6, ' ');
  std::ranges::generate(out, [&] { return letters[any(source)]; });
  return out;
}

/// Creates a file beside `target` and returns its name in `part`; -1 with errno on failure. Like
/// mkostemp(), but with the default mode of new files: the umask cannot be read without changing it
/// for all threads.
int create_beside(const std::string& target, std::string& part) {
  constexpr std::size_t longest_name = 255;  // file name length limit of all usual file systems
  const fs::path whole(target);
  const std::string ending = ".part-";
  std::string name = whole.filename().string();
  name.resize(std::min(name.size(), longest_name - ending.size() - 6));
  for (int tries = 0; tries < 100; ++tries) {
    part = (whole.parent_path() / (name + ending + random_letters())).string();
    const int file = ::open(part.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (file >= 0 || errno != EEXIST) return file;
  }
  return -1;
}

/// Gives a new file the owner and the mode of the file it will replace.
void take_over(int descriptor, const struct stat& replaced) {
  struct stat own{};
  if (::fstat(descriptor, &own) != 0) return;
  const bool other = own.st_uid != replaced.st_uid || own.st_gid != replaced.st_gid;
  // A user who may write a file may not be allowed to change its owner; the user then owns it.
  const bool given = !other || ::fchown(descriptor, replaced.st_uid, replaced.st_gid) == 0;
  constexpr mode_t permissions = 0777;
  constexpr mode_t all = 07777;
  ::fchmod(descriptor, replaced.st_mode & (given ? all : permissions));
}

}  // namespace

NewFile::NewFile(std::string path, std::string target, std::string part, int descriptor)
    : path_(std::move(path)),
      target_(std::move(target)),
      part_(std::move(part)),
      stream_(::fdopen(descriptor, target_.empty() ? "wb" : "w+b")) {}

NewFile::~NewFile() {
  if (stream_ && !target_.empty()) ::unlink(part_.c_str());
}

Error NewFile::failed(int error) const {
  return not_written(path_, error);
}

Result<NewFile> NewFile::create(const std::string& path) {
  const auto there = status_of_path(path);
  if (there && S_ISDIR(there->st_mode)) return not_written(path, EISDIR);
  if (there && (is_standard_output(*there) || !S_ISREG(there->st_mode))) {
    const int file = is_standard_output(*there)
                         ? ::fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)
                         : ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
    if (file < 0) return not_written(path, errno);
    return NewFile(path, {}, path, file);
  }
  if (there && ::access(path.c_str(), W_OK) != 0) return not_written(path, errno);
  int error = 0;
  std::string target = behind_links(path, error);
  if (error != 0) return not_written(path, error);
  std::string part;
  const int file = create_beside(target, part);
  if (file < 0) return not_written(path, errno);
  if (there) take_over(file, *there);
  return NewFile(path, std::move(target), std::move(part), file);
}

Status NewFile::append(std::string_view bytes) {
  if (bytes.empty()) return Done{};
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_.get()) != bytes.size())
    return failed(errno);
  return Done{};
}

Status NewFile::keep() {
  // The file under this name must be complete even after a power failure. A library may have
  // replaced this file by its own.
  const bool named = !target_.empty();
  const bool flushed =
      std::fflush(stream_.get()) == 0 && (!named || ::fsync(::fileno(stream_.get())) == 0);
  int error = errno;
  const bool closed = std::fclose(stream_.release()) == 0;
  if (flushed && !closed) error = errno;
  bool done = flushed && closed;
  if (done && named) {
    done = ::rename(part_.c_str(), target_.c_str()) == 0;
    error = errno;
  }
  if (done) return Done{};
  if (named) ::unlink(part_.c_str());
  return failed(error);
}

Status write_file(const std::string& path, std::string_view bytes) {
  auto file = NewFile::create(path);
  if (!file) return file.error();
  NewFile created = std::move(file).value();
  if (const Status written = created.append(bytes); !written) return written;
  return created.keep();
}

bool is_special_file(const std::string& path) {
  const auto there = status_of_path(path);
  return there && !S_ISREG(there->st_mode) && !S_ISDIR(there->st_mode);
}

bool is_same_or_within(const std::string& file, const std::string& file_or_folder) {
  const auto a = status_of_path(file);
  const auto b = status_of_path(file_or_folder);
  if (a && b && S_ISREG(a->st_mode) && is_one(*a, *b)) return true;
  if (a && !S_ISREG(a->st_mode)) return false;
  std::error_code problem;
  const fs::path inner = fs::weakly_canonical(fs::absolute(file, problem), problem);
  const fs::path outer = fs::weakly_canonical(fs::absolute(file_or_folder, problem), problem);
  if (inner == outer) return !inner.empty();
  if (!a || !b || !S_ISDIR(b->st_mode)) return false;
  return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

}  // namespace proofmass
