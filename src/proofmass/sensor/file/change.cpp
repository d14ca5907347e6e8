#include "proofmass/sensor/file/change.hpp"

#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "proofmass/sensor/sensor_file.hpp"

namespace proofmass::sensor {
namespace {

/// Serialises changes in a folder, so that none is lost between reading and writing; has no effect
/// on file systems without locks.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : folder_(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ >= 0) ::flock(folder_, LOCK_EX);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (folder_ >= 0) ::close(folder_);
  }

 private:
  int folder_;
};

}  // namespace

Status change_sensor_file(const std::string& path,
                          const std::function<Status(SensorModel&)>& change) {
  const FolderLock lock(std::filesystem::path(path).parent_path());
  SensorModel model;
  std::error_code unknown;
  // If the existence of the file is uncertain, assume that it exists and must not be lost.
  if (std::filesystem::exists(path, unknown) || unknown) {
    auto file = read_sensor_file(path);
    if (!file) return file.error();
    model = std::move(file).value().model;
  } else {
    model.name = std::filesystem::path(path).stem().string();
  }
  if (const Status done = change(model); !done) return done.error().at(path);
  return write_sensor_file(model, path);
}

}  // namespace proofmass::sensor
