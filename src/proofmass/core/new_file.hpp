#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass {

/// A file under construction that takes its name only when it is complete. Until then the file that
/// had the name before stays intact.
///
/// - A regular file, or none: the bytes go to "<path>.part-xxxxxx" in the same folder, which is
///   created exclusively for this writer: no existing file is opened and no link is followed.
///   keep() syncs it to the disk and renames it. The mode and, where permitted, the owner of the
///   replaced file are kept. A link at `path` is kept: the file it points to is replaced.
/// - A device, a pipe, a socket, or the file that standard output is open on: written in place.
class NewFile {
 public:
  /// Errors of all functions: unwritable, "<path>: cannot be written: No space left on device".
  [[nodiscard]] static Result<NewFile> create(const std::string& path);

  NewFile(NewFile&& other) noexcept = default;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();  ///< removes the file unless keep() has named it

  [[nodiscard]] Status append(std::string_view bytes);
  [[nodiscard]] std::FILE* stream() const { return stream_.get(); }
  /// Path of the bytes before keep(), for libraries that write files themselves.
  [[nodiscard]] const std::string& part_path() const { return part_; }
  [[nodiscard]] Status keep();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  NewFile(std::string path, std::string target, std::string part, int descriptor);
  [[nodiscard]] Error failed(int error) const;

  std::string path_;    ///< as given
  std::string target_;  ///< the file to replace; empty: written in place
  std::string part_;
  std::unique_ptr<std::FILE, Close> stream_;
};

/// Writes a whole file: create(), append() and keep().
[[nodiscard]] Status write_file(const std::string& path, std::string_view bytes);

/// True if the path names something that exists and is not a regular file; it is written in place.
[[nodiscard]] bool is_special_file(const std::string& path);

/// True if two paths name the same regular file, or would name it once it exists. A file also
/// counts as inside any folder that contains it, at any depth.
[[nodiscard]] bool is_same_or_within(const std::string& file, const std::string& file_or_folder);

}  // namespace proofmass
