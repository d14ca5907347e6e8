#include "proofmass/io/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <unistd.h>

namespace proofmass::io {
namespace {

Error cannot_write(const std::string& path, const std::string& why) {
  return Error{Errc::unreadable, path + ": cannot be written: " + why};
}

class StandardOutput final : public OutputFile {
 public:
  [[nodiscard]] Status append(std::string_view bytes) override {
    if (bytes.empty()) return Done{};
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size()) return failed();
    size_ += bytes.size();
    return Done{};
  }
  [[nodiscard]] Status overwrite(std::uint64_t, std::string_view) override {
    return cannot_write("standard output", "this format is written to files only: name one");
  }
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& part_path() const override { return path_; }
  [[nodiscard]] Status keep() override {
    return std::fflush(stdout) == 0 ? Status(Done{}) : failed();
  }

 private:
  static Error failed() {
    return cannot_write("standard output", std::generic_category().message(errno));
  }
  std::string path_ = "-";
  std::uint64_t size_ = 0;
};

class DiskFile final : public OutputFile {
 public:
  DiskFile(std::FILE* file, std::string path)
      : file_(file), path_(std::move(path)), part_(path_ + ".part") {}
  ~DiskFile() override {
    if (file_ == nullptr) return;
    std::fclose(file_);
    std::remove(part_.c_str());
  }

  [[nodiscard]] Status append(std::string_view bytes) override {
    if (bytes.empty()) return Done{};
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) return failed();
    size_ += bytes.size();
    return Done{};
  }
  [[nodiscard]] Status overwrite(std::uint64_t offset, std::string_view bytes) override {
    const bool done = ::fseeko(file_, static_cast<off_t>(offset), SEEK_SET) == 0 &&
                      std::fwrite(bytes.data(), 1, bytes.size(), file_) == bytes.size() &&
                      ::fseeko(file_, 0, SEEK_END) == 0;
    return done ? Status(Done{}) : failed();
  }
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& part_path() const override { return part_; }
  [[nodiscard]] Status keep() override {
    // What a power cut leaves under the name must be whole.
    const bool flushed = std::fflush(file_) == 0 && ::fsync(::fileno(file_)) == 0;
    const int why = errno;
    const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
    std::error_code problem;
    if (flushed && closed) std::filesystem::rename(part_, path_, problem);
    if (flushed && closed && !problem) return Done{};
    std::remove(part_.c_str());
    return cannot_write(path_, problem ? problem.message()
                                       : std::generic_category().message(flushed ? errno : why));
  }

 private:
  [[nodiscard]] Error failed() const {
    return cannot_write(path_, std::generic_category().message(errno));
  }
  std::FILE* file_;
  std::string path_;
  std::string part_;
  std::uint64_t size_ = 0;
};

}  // namespace

Result<std::unique_ptr<OutputFile>> create_file(const std::string& path) {
  using Created = std::unique_ptr<OutputFile>;
  if (path == "-") return Created(std::make_unique<StandardOutput>());
  std::FILE* file = std::fopen((path + ".part").c_str(), "w+b");
  if (file == nullptr) return cannot_write(path, std::generic_category().message(errno));
  return Created(std::make_unique<DiskFile>(file, path));
}

}  // namespace proofmass::io
