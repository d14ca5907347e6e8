#include "proofmass/acquire/recorder/part_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "proofmass/io/unnamed_file.hpp"

namespace proofmass::acquire {
namespace {

Error cannot(const std::string& path, const char* what) {
  return {Errc::unwritable,
          fmt::format("{}: {}: {}", path, what, std::generic_category().message(errno))};
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

bool is_there(const std::string& path) {
  struct stat found{};
  return ::lstat(path.c_str(), &found) == 0;
}

class DiskPart final : public PartFile {
 public:
  DiskPart(int descriptor, int reserve, PartNames names)
      : descriptor_(descriptor), reserve_(reserve), names_(std::move(names)) {}
  ~DiskPart() override {
    drop_reserve();
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  [[nodiscard]] Status append(std::string_view bytes) override {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written == 0) errno = ENOSPC;
      if (written <= 0) return cannot(names_.part, "cannot be written");
      bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return Done{};
  }

  [[nodiscard]] Status sync() override {
    if (::fdatasync(descriptor_) == 0) return Done{};
    return cannot(names_.part, "cannot be brought to the disk");
  }

  [[nodiscard]] Status truncate(std::uint64_t bytes) override {
    drop_reserve();
    const auto end = static_cast<off_t>(bytes);
    if (::ftruncate(descriptor_, end) == 0 && ::lseek(descriptor_, end, SEEK_SET) == end)
      return Done{};
    return cannot(names_.part, "cannot be cut");
  }

  [[nodiscard]] Status keep() override {
    drop_reserve();
    if (::fsync(descriptor_) != 0) return cannot(names_.part, "cannot be brought to the disk");
    if (::close(std::exchange(descriptor_, -1)) != 0)
      return cannot(names_.part, "cannot be closed");
    if (const Status named = rename_part(); !named) return named;
    // The directory entry must also survive a power failure; not every file system supports this
    // sync.
    const int folder = ::open(folder_of(names_.path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      (void)::fsync(folder);
      ::close(folder);
    }
    return Done{};
  }

  void discard() override { ::unlink(names_.part.c_str()); }

 private:
  [[nodiscard]] Status rename_part() const {
    const char* part = names_.part.c_str();
    const char* path = names_.path.c_str();
    if (::renameat2(AT_FDCWD, part, AT_FDCWD, path, RENAME_NOREPLACE) == 0) return Done{};
    if (errno == EEXIST)
      return Error{Errc::unwritable, fmt::format("{}: is there by now; the recording stays in {}",
                                                 names_.path, names_.part)};
    // File systems without RENAME_NOREPLACE.
    if (errno == EINVAL && !is_there(names_.path) && ::rename(part, path) == 0) return Done{};
    return cannot(names_.path, "cannot be given its name");
  }

  void drop_reserve() {
    if (reserve_ >= 0) ::close(std::exchange(reserve_, -1));
  }

  int descriptor_;
  int reserve_;  ///< an unnamed file that reserves space; -1: none
  PartNames names_;
};

class NoPart final : public PartFile {
 public:
  [[nodiscard]] Status append(std::string_view /*bytes*/) override { return Done{}; }
  [[nodiscard]] Status sync() override { return Done{}; }
  [[nodiscard]] Status truncate(std::uint64_t /*bytes*/) override { return Done{}; }
  [[nodiscard]] Status keep() override { return Done{}; }
  void discard() override {}
};

/// Space that is released when the descriptor is closed; -1 if none can be reserved.
int room_kept_in(const std::string& folder) {
  constexpr std::uint64_t wanted = std::uint64_t{1} << 20;
  struct statvfs disk{};
  if (::statvfs(folder.c_str(), &disk) != 0) return -1;
  const std::uint64_t free_bytes = std::uint64_t{disk.f_bavail} * disk.f_frsize;
  const std::uint64_t bytes = std::min(wanted, free_bytes / 8);
  const int file = bytes > 0 ? io::unnamed_file(folder) : -1;
  if (file < 0) return -1;
  if (::posix_fallocate(file, 0, static_cast<off_t>(bytes)) == 0) return file;
  ::close(file);
  return -1;
}

}  // namespace

PartNames part_names(const std::string& path) {
  return {path, path + ".part"};
}

Result<std::unique_ptr<PartFile>> create_part_file(const PartNames& names) {
  if (is_there(names.path))
    return Error{
        Errc::invalid_argument,
        fmt::format("{}: is there already; choose another name or move it away", names.path)};
  const int file = ::open(names.part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0 && errno == EEXIST)
    return Error{Errc::invalid_argument,
                 fmt::format("{}: is there, of a recording that was not closed; recover it first: "
                             "proofmass recover {}",
                             names.part, names.part)};
  if (file < 0) return cannot(names.part, "cannot be created");
  const int reserve = room_kept_in(folder_of(names.path));
  return std::unique_ptr<PartFile>(std::make_unique<DiskPart>(file, reserve, names));
}

Result<std::unique_ptr<PartFile>> create_no_file(const PartNames& /*names*/) {
  return std::unique_ptr<PartFile>(std::make_unique<NoPart>());
}

}  // namespace proofmass::acquire
