#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "proofmass/core/result.hpp"

namespace proofmass::serve {

/// A file as the page lists it.
struct FolderEntry {
  std::string name;  ///< path within the folder
  std::uint64_t bytes = 0;
  std::int64_t modified_s = 0;  ///< since 1970
  friend bool operator==(const FolderEntry&, const FolderEntry&) = default;
};

/// The folder that is served. No name leads out of it, by ".." or by a symbolic link.
class Folder {
 public:
  /// A folder, or one file: then nothing else in its folder is served.
  /// Errors: unreadable (no such file or folder).
  [[nodiscard]] static Result<Folder> open(const std::string& path);

  [[nodiscard]] const std::string& path() const { return path_; }  ///< absolute, without links
  [[nodiscard]] const std::string& only() const { return only_; }  ///< the one file; else empty

  /// The name of a regular file that exists within the folder, without "." and doubled slashes.
  /// Errors: invalid_argument (leads out of the folder), unreadable (no such file).
  [[nodiscard]] Result<std::string> existing(std::string_view name) const;

  /// Gives a file in this folder a name that is not taken: "a.csv" becomes "a-2.csv" where there is
  /// one. Returns the name. Errors: invalid_argument (a name with a slash, hidden, or longer than
  /// 200 bytes), unwritable.
  [[nodiscard]] Result<std::string> adopt(const std::string& from, std::string_view name) const;

  /// Files whose names end like one of these, at most four folders deep, without hidden ones,
  /// sorted by name; the first `most`.
  [[nodiscard]] std::vector<FolderEntry> list(const std::vector<std::string_view>& endings,
                                              std::size_t most) const;

 private:
  Folder(std::string path, std::string only) : path_(std::move(path)), only_(std::move(only)) {}
  std::string path_, only_;
};

}  // namespace proofmass::serve
