#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <system_error>

#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/archive/names.hpp"

namespace proofmass::io {
namespace {

namespace fs = std::filesystem;

/// Folders with more files are not recordings: the user probably named a home folder.
constexpr std::size_t most_files = 10'000;

class FolderArchive final : public Archive {
 public:
  void add(std::string name, std::uint64_t size, std::string path) {
    files_.push_back({{std::move(name), size}, std::move(path)});
  }
  [[nodiscard]] std::size_t files() const { return files_.size(); }
  void sort() {
    std::ranges::sort(files_, {}, [](const File& file) { return file.entry.name; });
    for (const File& file : files_) entries_.push_back(file.entry);
  }

  [[nodiscard]] std::span<const ArchiveEntry> entries() const override { return entries_; }
  [[nodiscard]] Result<std::unique_ptr<PeekSource>> open(std::size_t entry) override {
    auto file = open_file(files_[entry].path);
    if (!file) return file.error().at(entries_[entry].name);
    auto source = unwrap(std::move(file).value());
    if (!source) return source.error().at(entries_[entry].name);
    return source;
  }

 private:
  struct File {
    ArchiveEntry entry;
    std::string path;
  };
  std::vector<File> files_;
  std::vector<ArchiveEntry> entries_;
};

/// Adds the regular files of a folder, and of its subfolders up to `levels`. An unreadable
/// subfolder is skipped.
Status gather(const fs::path& folder,
              const std::string& prefix,
              int levels,
              FolderArchive& archive) {
  std::error_code problem;
  fs::directory_iterator entry(folder, fs::directory_options::skip_permission_denied, problem);
  if (problem && prefix.empty())
    return Error{Errc::unreadable, "cannot be opened: " + problem.message()};
  for (; !problem && entry != fs::directory_iterator(); entry.increment(problem)) {
    const std::string name = prefix + plain_name(entry->path().filename().string());
    std::error_code gone;
    const auto status = entry->status(gone);
    if (fs::is_regular_file(status)) {
      const std::uintmax_t size = entry->file_size(gone);
      archive.add(name, gone ? 0 : size, entry->path().string());
    } else if (fs::is_directory(status) && levels > 1) {
      if (const Status done = gather(entry->path(), name + "/", levels - 1, archive); !done)
        return done;
    }
    if (archive.files() > most_files)
      return Error{Errc::unsupported,
                   fmt::format("is a folder of more than {} files: name one of them, or a folder "
                               "further down",
                               most_files)};
  }
  return Done{};
}

}  // namespace

Result<std::unique_ptr<Archive>> open_folder(const std::string& path) {
  auto archive = std::make_unique<FolderArchive>();
  constexpr int levels = 2;
  if (const Status done = gather(path, "", levels, *archive); !done) return done.error();
  archive->sort();
  return std::unique_ptr<Archive>(std::move(archive));
}

}  // namespace proofmass::io
