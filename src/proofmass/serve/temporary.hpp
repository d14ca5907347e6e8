#pragma once

#include <string>

#include "proofmass/core/result.hpp"

namespace proofmass::serve {

/// Makes an empty file of a name that was not taken, for this user alone. Errors: unwritable.
[[nodiscard]] Result<std::string> temporary_file(const std::string& folder,
                                                 const std::string& prefix);

/// A folder for this user alone, which goes with all that is in it.
class TemporaryFolder {
 public:
  /// In $TMPDIR's place `parent`. Errors: unwritable.
  [[nodiscard]] static Result<TemporaryFolder> make(const std::string& parent);
  TemporaryFolder(TemporaryFolder&& other) noexcept;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace proofmass::serve
