#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass {

/// A file that is being written and takes its name only when it is complete, so that whatever had
/// the name before is whole until then.
///
/// - A regular file, or none: the bytes go to "<path>.part-xxxxxx" in the same folder, which is
///   created for this writer alone: nothing that exists is opened, no link followed. keep() brings
///   it to the disk and renames it; the mode, and where permitted the owner, of the file that it
///   replaces are kept. A link at `path` is kept: the file that it leads to is replaced.
/// - A device, a pipe or a socket, and what standard output is open on: written into as it is.
class NewFile {
 public:
  /// Errors of all: unwritable, "<path>: cannot be written: No space left on device".
  [[nodiscard]] static Result<NewFile> create(const std::string& path);

  NewFile(NewFile&& other) noexcept = default;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();  ///< removes what keep() has not named

  [[nodiscard]] Status append(std::string_view bytes);
  [[nodiscard]] std::FILE* stream() const { return stream_.get(); }
  /// Where the bytes are before keep(): for libraries that write files themselves.
  [[nodiscard]] const std::string& part_path() const { return part_; }
  [[nodiscard]] Status keep();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  NewFile(std::string path, std::string target, std::string part, int descriptor);
  [[nodiscard]] Error failed(int error) const;

  std::string path_;    ///< as given
  std::string target_;  ///< the file to replace; empty: written into directly
  std::string part_;
  std::unique_ptr<std::FILE, Close> stream_;
};

/// Writes a whole file: create(), append() and keep().
[[nodiscard]] Status write_file(const std::string& path, std::string_view bytes);

/// Whether a path names something that exists and is no regular file, which is written into.
[[nodiscard]] bool is_special_file(const std::string& path);

/// Whether two paths name one regular file; of a file that does not exist, whether they will. A
/// file is in a folder that holds it, at any depth, too.
[[nodiscard]] bool is_same_or_within(const std::string& file, const std::string& file_or_folder);

}  // namespace proofmass
