#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "proofmass/core/result.hpp"

namespace proofmass::acquire {

/// A file that is written from front to end and gets its name once it is whole. Until then, and
/// whatever happens, what was written is in the part.
class PartFile {
 public:
  PartFile() = default;
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;
  virtual ~PartFile() = default;

  /// Errors of all: unwritable, "run.mcap.part: cannot be written: No space left on device".
  [[nodiscard]] virtual Status append(std::string_view bytes) = 0;
  /// What was appended is on the disk.
  [[nodiscard]] virtual Status sync() = 0;
  /// Forgets what is behind, and gives the room back that was kept for the end of the file.
  [[nodiscard]] virtual Status truncate(std::uint64_t bytes) = 0;
  /// Gives it its name; never over another file.
  [[nodiscard]] virtual Status keep() = 0;
  /// Removes the part, which holds nothing worth keeping.
  virtual void discard() = 0;
};

/// Where a file is and will be.
struct PartNames {
  std::string path;
  std::string part;
};
using CreatePartFile = std::function<Result<std::unique_ptr<PartFile>>(const PartNames& names)>;

/// "run.mcap.part" for "run.mcap".
[[nodiscard]] PartNames part_names(const std::string& path);

/// A megabyte, at most an eighth of the free room, is kept aside so that a file on a full disk can
/// be closed. Errors: invalid_argument (one of the names is there: what to do with it), unreadable
/// (it cannot be created: why).
[[nodiscard]] Result<std::unique_ptr<PartFile>> create_part_file(const PartNames& names);

}  // namespace proofmass::acquire
