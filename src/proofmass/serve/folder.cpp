#include "proofmass/serve/folder.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fmt/format.h>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

#include "proofmass/core/utf8.hpp"

namespace proofmass::serve {
namespace {

namespace fs = std::filesystem;

bool is_within(const fs::path& folder, const fs::path& path) {
  const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end() && rest != path.end();
}

std::optional<FolderEntry> entry_of(const std::string& path, std::string name) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  return FolderEntry{std::move(name), static_cast<std::uint64_t>(found.st_size), found.st_mtime};
}

bool ends_like(std::string name, const std::vector<std::string_view>& endings) {
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::any_of(endings, [&](std::string_view one) { return name.ends_with(one); });
}

}  // namespace

Result<Folder> Folder::open(const std::string& path) {
  std::error_code failed;
  const fs::path real = fs::canonical(path, failed);
  if (failed) return Error{Errc::unreadable, path + ": " + failed.message()};
  if (fs::is_directory(real, failed)) return Folder(real.string(), {});
  if (fs::is_regular_file(real, failed))
    return Folder(real.parent_path().string(), real.filename().string());
  return Error{Errc::unreadable, path + ": expected a folder or a file"};
}

Result<std::string> Folder::existing(std::string_view name) const {
  const Error outside{Errc::invalid_argument, "the file lies outside the folder that is served"};
  const fs::path given(name);
  if (name.empty() || name.find('\0') != std::string_view::npos || given.is_absolute())
    return outside;
  if (std::ranges::any_of(given, [](const fs::path& part) { return part == ".."; })) return outside;
  const std::string plain = given.lexically_normal().string();
  if (!only_.empty() && plain != only_) return outside;
  std::error_code failed;
  const fs::path real = fs::canonical(fs::path(path_) / plain, failed);
  if (failed) return Error{Errc::unreadable, fmt::format("{}: {}", plain, failed.message())};
  if (!is_within(path_, real)) return outside;
  if (!fs::is_regular_file(real, failed)) return Error{Errc::unreadable, plain + ": is not a file"};
  return plain;
}

Result<std::string> Folder::adopt(const std::string& from, std::string_view name) const {
  constexpr std::size_t longest = 200, most_tries = 1000;
  const fs::path given(name);
  if (name.empty() || name.size() > longest || name.front() == '.' || !is_utf8(name) ||
      name.find('/') != std::string_view::npos || name.find('\0') != std::string_view::npos)
    return Error{Errc::invalid_argument, "expected the name of a file, without a path"};
  if (!only_.empty()) return Error{Errc::invalid_argument, "only one file is served"};
  for (std::size_t k = 1; k < most_tries; ++k) {
    const std::string candidate =
        k == 1 ? std::string(name)
               : fmt::format("{}-{}{}", given.stem().string(), k, given.extension().string());
    // A link, unlike a renamed file, never takes the place of another.
    if (::link(from.c_str(), (path_ + "/" + candidate).c_str()) == 0) return candidate;
    if (errno != EEXIST)
      return Error{Errc::unwritable, fmt::format("{}: {}", candidate, std::strerror(errno))};
  }
  return Error{Errc::unwritable, std::string(name) + ": this name and its numbers are taken"};
}

std::vector<FolderEntry> Folder::list(const std::vector<std::string_view>& endings,
                                      std::size_t most) const {
  constexpr int deepest = 3;
  std::vector<FolderEntry> found;
  std::error_code failed;
  fs::recursive_directory_iterator at(path_, fs::directory_options::skip_permission_denied, failed);
  for (; !failed && at != fs::recursive_directory_iterator(); at.increment(failed)) {
    const std::string base = at->path().filename().string();
    std::error_code ignored;
    if (at->is_directory(ignored) && (base.starts_with('.') || at.depth() >= deepest))
      at.disable_recursion_pending();
    if (base.starts_with('.') || !ends_like(base, endings)) continue;
    const std::string name = at->path().lexically_relative(path_).string();
    if (!is_utf8(name) || !existing(name)) continue;
    if (auto entry = entry_of(at->path().string(), name)) found.push_back(std::move(*entry));
    if (found.size() >= 16 * most) break;
  }
  std::ranges::sort(found, {}, &FolderEntry::name);
  if (found.size() > most) found.resize(most);
  return found;
}

}  // namespace proofmass::serve
