#include "proofmass/acquire/recover.hpp"

#include <filesystem>
#include <system_error>
#include <unistd.h>

#include "proofmass/acquire/recorder/part_file.hpp"
#include "proofmass/io/mcap/salvage.hpp"

namespace proofmass::acquire {
namespace {

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code problem;  // for a file that does not exist yet
  return a == b || std::filesystem::equivalent(a, b, problem);
}

}  // namespace

Result<Recovery> recover(const std::string& from, const std::string& to, const Progress& progress) {
  // The file to be recovered may be the part of a recording.
  const PartNames names{to, to + ".recovered.part"};
  if (is_same_file(from, to) || is_same_file(from, names.part))
    return Error{Errc::invalid_argument,
                 from + ": is not written over; give the recovered file another name"};
  std::shared_ptr<PartFile> part;
  const auto put = [&](const std::string& bytes) -> Status {
    if (!part) {
      auto created = create_part_file(names);
      if (!created) return created.error();
      part = std::move(created).value();
    }
    return part->append(bytes);
  };
  auto saved = io::mcap::salvage(from, put, progress);
  if (!part && !saved) return saved.error();
  if (saved && saved->messages == 0)
    saved = Error{Errc::corrupt, from + ": holds no message that could be saved"};
  const Status kept = saved ? part->keep() : Status(saved.error());
  if (!kept) {
    ::unlink(names.part.c_str());
    return kept.error();
  }
  Recovery recovery = std::move(saved).value();
  recovery.file = to;
  return recovery;
}

}  // namespace proofmass::acquire
