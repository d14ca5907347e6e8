#include "proofmass/fleet/results.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "proofmass/fleet/entry_json.hpp"

namespace proofmass::fleet {
namespace {

namespace fs = std::filesystem;

std::string journal_name(const Shard& shard) {
  return shard.n == 1 ? "journal.ndjson" : fmt::format("journal-{}-of-{}.ndjson", shard.i, shard.n);
}

Error journal_error(Errc code, const std::string& path, const char* what) {
  return {code, fmt::format("{}: {}: {}", path, what, std::strerror(errno))};
}

std::vector<std::string> journals_in(const std::string& folder) {
  std::vector<std::string> found;
  std::error_code problem;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem)) {
    const std::string name = at->path().filename().string();
    if (name.starts_with("journal") && name.ends_with(".ndjson"))
      found.push_back(at->path().string());
  }
  std::ranges::sort(found);
  return found;
}

bool write_whole(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

// What a process that was killed has left behind.
void remove_parts(const std::string& folder) {
  std::error_code problem;
  std::vector<fs::path> parts;
  for (fs::directory_iterator at(folder, problem), end; !problem && at != end;
       at.increment(problem))
    if (at->path().filename().string().find(".part-") != std::string::npos)
      parts.push_back(at->path());
  for (const fs::path& part : parts) fs::remove(part, problem);
}

}  // namespace

/// The journals' descriptors; the last may be the one that is added to.
class Results::Files {
 public:
  struct Journal {
    std::string path;
    int descriptor = -1;
    std::uint64_t read = 0;  // bytes of it that are known
  };
  Files() = default;
  Files(const Files&) = delete;
  Files& operator=(const Files&) = delete;
  ~Files() {
    for (const Journal& journal : all) ::close(journal.descriptor);
  }

  Status add(const std::string& path) {
    const bool is_known =
        std::ranges::any_of(all, [&](const Journal& journal) { return journal.path == path; });
    if (is_known) return Done{};
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return journal_error(Errc::unreadable, path, "cannot be read");
    all.push_back({path, descriptor});
    return Done{};
  }

  std::vector<Journal> all;
  std::optional<std::size_t> own;
};

Results::Results(std::string folder)
    : folder_(std::move(folder)), files_(std::make_unique<Files>()) {}
Results::Results(Results&&) noexcept = default;
Results& Results::operator=(Results&&) noexcept = default;
Results::~Results() = default;

Status Results::index(std::size_t number) {
  Files::Journal& journal = files_->all[number];
  std::vector<char> buffer(std::size_t{1} << 20U);
  std::string pending;
  std::uint64_t begin = journal.read;
  for (;;) {
    const ssize_t count = ::pread(journal.descriptor, buffer.data(), buffer.size(),
                                  static_cast<off_t>(begin + pending.size()));
    if (count < 0) return journal_error(Errc::unreadable, journal.path, "cannot be read");
    if (count == 0) break;
    pending.append(buffer.data(), static_cast<std::size_t>(count));
    std::size_t from = 0;
    for (std::size_t end = pending.find('\n'); end != std::string::npos;
         end = pending.find('\n', from)) {
      const std::string_view line = std::string_view(pending).substr(from, end - from);
      const Place place{number, begin + from, line.size(), ended_of_line(line)};
      if (const auto id = id_of_line(line)) {
        const auto [known, is_new] = places_.try_emplace(*id, place);
        if (!is_new && known->second.ended_s <= place.ended_s) known->second = place;
      }
      from = end + 1;
    }
    pending.erase(0, from);
    begin += from;
  }
  journal.read = begin;
  return Done{};
}

Status Results::refresh() {
  for (const std::string& path : journals_in(folder_))
    if (const Status added = files_->add(path); !added) return added;
  for (std::size_t k = 0; k < files_->all.size(); ++k)
    if (const Status read = index(k); !read) return read;
  return Done{};
}

Result<Results> Results::read(const std::string& folder) {
  Results results(folder);
  if (const Status read = results.refresh(); !read) return read.error();
  if (results.files_->all.empty())
    return Error{Errc::unreadable,
                 folder + ": holds no results of a fleet: expected the folder that --into named"};
  return results;
}

Result<Results> Results::open(const std::string& folder, const Shard& shard) {
  std::error_code problem;
  fs::create_directories(fs::path(folder) / "documents", problem);
  if (problem) return Error{Errc::unwritable, folder + ": cannot be made: " + problem.message()};
  const std::string path = (fs::path(folder) / journal_name(shard)).string();
  const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return journal_error(Errc::unwritable, path, "cannot be written");
  Results results(folder);
  results.files_->all.push_back({path, descriptor});
  results.files_->own = 0;
  if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
    return Error{Errc::invalid_argument,
                 path + ": another process adds to it: wait for its end, or name another --into"};
  if (const Status read = results.refresh(); !read) return read.error();
  // What a kill left unfinished would join the next line.
  const std::uint64_t whole = results.files_->all[0].read;
  if (::ftruncate(descriptor, static_cast<off_t>(whole)) != 0)
    return journal_error(Errc::unwritable, path, "cannot be written");
  if (shard.n == 1) remove_parts((fs::path(folder) / "documents").string());
  return results;
}

std::optional<Entry> Results::at(const Place& place) const {
  std::string line(place.bytes, '\0');
  std::size_t got = 0;
  while (got < line.size()) {
    const ssize_t count = ::pread(files_->all[place.journal].descriptor, line.data() + got,
                                  line.size() - got, static_cast<off_t>(place.offset + got));
    if (count <= 0) return std::nullopt;
    got += static_cast<std::size_t>(count);
  }
  return entry_of_line(line);
}

std::optional<Entry> Results::find(const std::string& id) const {
  const auto found = places_.find(id);
  return found == places_.end() ? std::nullopt : at(found->second);
}

Status Results::visit(const std::function<Status(const Entry&)>& take) const {
  for (const auto& [id, place] : places_) {
    const auto entry = at(place);
    if (!entry) return Error{Errc::unreadable, folder_ + ": a journal cannot be read"};
    if (const Status taken = take(*entry); !taken) return taken;
  }
  return Done{};
}

Status Results::append(const Entry& entry) {
  PM_EXPECTS(files_->own.has_value());
  const std::size_t own = *files_->own;
  Files::Journal& journal = files_->all[own];
  const std::string line = line_of(entry);
  if (!write_whole(journal.descriptor, line + '\n'))
    return journal_error(Errc::unwritable, journal.path, "cannot be written");
  places_[entry.id()] = {own, journal.read, line.size(), entry.ended_s};
  journal.read += line.size() + 1;
  return Done{};
}

std::string document_stem(const Job& job) {
  // FNV-1a of 64 bits. Source: draft-eastlake-fnv, section 5.
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : job.id()) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return fmt::format("{}-{:016x}", fs::path(job.path).filename().string(), hash);
}

}  // namespace proofmass::fleet
