#include "proofmass/io/bytes/output_file.hpp"

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "proofmass/core/new_file.hpp"

namespace proofmass::io {
namespace {

Error cannot_write(const std::string& path, const std::string& why) {
  return Error{Errc::unwritable, path + ": cannot be written: " + why};
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
  DiskFile(NewFile file, std::string path) : file_(std::move(file)), path_(std::move(path)) {}

  [[nodiscard]] Status append(std::string_view bytes) override {
    const Status written = file_.append(bytes);
    if (written) size_ += bytes.size();
    return written;
  }
  [[nodiscard]] Status overwrite(std::uint64_t offset, std::string_view bytes) override {
    std::FILE* stream = file_.stream();
    const bool done = ::fseeko(stream, static_cast<off_t>(offset), SEEK_SET) == 0 &&
                      std::fwrite(bytes.data(), 1, bytes.size(), stream) == bytes.size() &&
                      ::fseeko(stream, 0, SEEK_END) == 0;
    return done ? Status(Done{}) : cannot_write(path_, std::generic_category().message(errno));
  }
  [[nodiscard]] std::uint64_t size() const override { return size_; }
  [[nodiscard]] const std::string& part_path() const override { return file_.part_path(); }
  [[nodiscard]] Status keep() override { return file_.keep(); }

 private:
  NewFile file_;
  std::string path_;
  std::uint64_t size_ = 0;
};

}  // namespace

Result<std::unique_ptr<OutputFile>> create_file(const std::string& path) {
  using Created = std::unique_ptr<OutputFile>;
  if (path == "-") return Created(std::make_unique<StandardOutput>());
  auto file = NewFile::create(path);
  if (!file) return file.error();
  return Created(std::make_unique<DiskFile>(std::move(file).value(), path));
}

}  // namespace proofmass::io
