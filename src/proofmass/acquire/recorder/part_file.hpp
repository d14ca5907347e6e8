#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// A file that is written sequentially and is renamed once it is complete. Until then the written
/// data are in the part file, whatever happens.
class PartFile {
 public:
  PartFile() = default;
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  virtual ~PartFile() = default;

  /// Errors of all functions: unwritable, "run.mcap.part: cannot be written: No space left on
  /// device".
  [[nodiscard]] virtual Status append(std::string_view bytes) = 0;
  /// Syncs the appended data to the disk.
  [[nodiscard]] virtual Status sync() = 0;
  /// Removes everything after `bytes`, and releases the space reserved for the end of the file.
  [[nodiscard]] virtual Status truncate(std::uint64_t bytes) = 0;
  /// Renames the part to the file; never overwrites another file.
  [[nodiscard]] virtual Status keep() = 0;
  /// Removes the part, which has nothing worth keeping.
  virtual void discard() = 0;
};

/// Current and final path of a file.
struct PartNames {
  std::string path;
  std::string part;
};
using CreatePartFile = std::function<Result<std::unique_ptr<PartFile>>(const PartNames& names)>;

/// "run.mcap.part" for "run.mcap".
[[nodiscard]] PartNames part_names(const std::string& path);

/// A megabyte, at most an eighth of the free space, is reserved so that a file on a full disk can
/// be closed. Errors: invalid_argument (one of the names exists: what to do with it), unreadable
/// (it cannot be created: why).
[[nodiscard]] Result<std::unique_ptr<PartFile>> create_part_file(const PartNames& names);

/// A part that keeps nothing and never fails: for samples that are only looked at.
[[nodiscard]] Result<std::unique_ptr<PartFile>> create_no_file(const PartNames& names);

}  // namespace proofmass::acquire
