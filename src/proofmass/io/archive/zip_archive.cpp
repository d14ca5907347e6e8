#include <algorithm>
#include <fmt/format.h>
#include <limits>
#include <numeric>
#include <zip.h>

#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/archive/names.hpp"

namespace proofmass::io {
namespace {

/// The archive's bytes in the form required by libzip, one position at a time.
class ZipBytes {
 public:
  explicit ZipBytes(std::unique_ptr<RandomBytes> bytes) : bytes_(std::move(bytes)) {}

  /// libzip's callback. Source: libzip 1.7, zip_source_function(3).
  static zip_int64_t answer(void* self, void* data, zip_uint64_t length, zip_source_cmd_t command) {
    return static_cast<ZipBytes*>(self)->obey(data, length, command);
  }

 private:
  zip_int64_t obey(void* data, zip_uint64_t length, zip_source_cmd_t command) {
    switch (command) {
      case ZIP_SOURCE_OPEN:
        position_ = 0;
        return 0;
      case ZIP_SOURCE_READ:
        return read(static_cast<char*>(data), length);
      case ZIP_SOURCE_SEEK: {
        const zip_int64_t place =
            zip_source_seek_compute_offset(position_, bytes_->size(), data, length, &error_);
        if (place >= 0) position_ = static_cast<std::uint64_t>(place);
        return place < 0 ? -1 : 0;
      }
      case ZIP_SOURCE_TELL:
        return static_cast<zip_int64_t>(position_);
      case ZIP_SOURCE_STAT: {
        auto* stat = static_cast<zip_stat_t*>(data);
        zip_stat_init(stat);
        stat->size = bytes_->size();
        stat->valid |= ZIP_STAT_SIZE;
        return sizeof(zip_stat_t);
      }
      case ZIP_SOURCE_ERROR:
        return zip_error_to_data(&error_, data, length);
      case ZIP_SOURCE_SUPPORTS:
        return zip_source_make_command_bitmap(ZIP_SOURCE_OPEN, ZIP_SOURCE_READ, ZIP_SOURCE_CLOSE,
                                              ZIP_SOURCE_STAT, ZIP_SOURCE_ERROR, ZIP_SOURCE_SEEK,
                                              ZIP_SOURCE_TELL, ZIP_SOURCE_FREE, -1);
      case ZIP_SOURCE_CLOSE:
      case ZIP_SOURCE_FREE:
        return 0;
      default:
        zip_error_set(&error_, ZIP_ER_OPNOTSUPP, 0);
        return -1;
    }
  }

  zip_int64_t read(char* into, zip_uint64_t length) {
    constexpr zip_uint64_t most = std::uint64_t{1} << 30;
    const auto count =
        bytes_->read_at(position_, {into, static_cast<std::size_t>(std::min(length, most))});
    if (!count) {
      zip_error_set(&error_, ZIP_ER_READ, 0);
      return -1;
    }
    position_ += *count;
    return static_cast<zip_int64_t>(*count);
  }

  std::unique_ptr<RandomBytes> bytes_;
  std::uint64_t position_ = 0;
  zip_error_t error_{};
};

/// An archive opened by libzip, with its bytes.
struct OpenZip {
  explicit OpenZip(std::unique_ptr<RandomBytes> from) : bytes(std::move(from)) {}
  OpenZip(const OpenZip&) = delete;
  OpenZip& operator=(const OpenZip&) = delete;
  ~OpenZip() {
    if (zip != nullptr) zip_discard(zip);
  }
  ZipBytes bytes;
  zip_t* zip = nullptr;
};

/// One entry, decompressed. Truncated data or a wrong checksum end it with a note.
class EntrySource final : public ByteSource {
 public:
  EntrySource(std::shared_ptr<OpenZip> zip, zip_file_t* file, const zip_stat_t& stat)
      : zip_(std::move(zip)), file_(file), claimed_(stat.size), packed_(stat.comp_size) {
    // The size is reliable only for uncompressed entries.
    if (stat.comp_method == ZIP_CM_STORE) size_ = std::min(stat.size, stat.comp_size);
  }
  ~EntrySource() override { zip_fclose(file_); }

  Result<std::size_t> read(std::span<char> into) override {
    if (ended_ || into.empty()) return std::size_t{0};
    // Numbers as text compress to a tenth; to a hundredth if most of them repeat.
    constexpr std::uint64_t large = std::uint64_t{1} << 30, most_packed = 250;
    if (position_ > large && position_ / most_packed > packed_)
      return Error{Errc::unsupported,
                   fmt::format("unpacks to more than {} times its size: made to fill a disk, or "
                               "nearly empty; unpack it by hand",
                               most_packed)};
    const zip_int64_t count = zip_fread(file_, into.data(), into.size());
    if (count > 0) {
      position_ += static_cast<std::uint64_t>(count);
      return static_cast<std::size_t>(count);
    }
    ended_ = true;
    if (count == 0) {
      if (position_ < claimed_) note_ = break_off();
    } else {
      const int code = zip_error_code_zip(zip_file_get_error(file_));
      note_ =
          code == ZIP_ER_CRC ? "the zip's checksum does not fit what was unpacked" : break_off();
    }
    if (position_ == 0 && !note_.empty()) return Error{Errc::corrupt, note_};
    return std::size_t{0};
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return size_; }
  [[nodiscard]] double fraction_read() const override {
    if (claimed_ == 0) return 0.0;
    return std::min(1.0, static_cast<double>(position_) / static_cast<double>(claimed_));
  }
  [[nodiscard]] std::vector<Note> notes() const override {
    if (note_.empty()) return {};
    return {{Severity::bad, note_ + "; what was read before is kept"}};
  }

 private:
  [[nodiscard]] std::string break_off() const {
    return fmt::format("the zipped data are damaged or break off after byte {} of {} unpacked",
                       position_, claimed_);
  }

  std::shared_ptr<OpenZip> zip_;
  zip_file_t* file_;
  std::uint64_t claimed_;
  std::uint64_t packed_;
  std::optional<std::uint64_t> size_;
  std::uint64_t position_ = 0;
  bool ended_ = false;
  std::string note_;
};

class ZipArchive final : public Archive {
 public:
  ZipArchive(std::shared_ptr<OpenZip> zip,
             std::vector<ArchiveEntry> entries,
             std::vector<zip_uint64_t> places)
      : zip_(std::move(zip)), entries_(std::move(entries)), places_(std::move(places)) {}

  [[nodiscard]] std::span<const ArchiveEntry> entries() const override { return entries_; }
  [[nodiscard]] Result<std::unique_ptr<PeekSource>> open(std::size_t entry) override {
    auto source = open_entry(places_[entry]);
    if (!source) return source.error().at(entries_[entry].name);
    auto unwrapped = unwrap(std::move(source).value());
    if (!unwrapped) return unwrapped.error().at(entries_[entry].name);
    return unwrapped;
  }

 private:
  [[nodiscard]] Result<std::unique_ptr<ByteSource>> open_entry(zip_uint64_t place) {
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(zip_->zip, place, 0, &stat) != 0)
      return Error{Errc::corrupt, "the zip's directory is damaged"};
    if (stat.encryption_method != ZIP_EM_NONE)
      return Error{Errc::unsupported, "is encrypted: unpack it first"};
    zip_file_t* file = zip_fopen_index(zip_->zip, place, 0);
    if (file != nullptr)
      return std::unique_ptr<ByteSource>(std::make_unique<EntrySource>(zip_, file, stat));
    if (zip_error_code_zip(zip_get_error(zip_->zip)) == ZIP_ER_COMPNOTSUPP)
      return Error{Errc::unsupported,
                   fmt::format("is compressed by method {}, which is not read: unpack it first",
                               stat.comp_method)};
    return Error{Errc::corrupt, "is not where the zip's directory says"};
  }

  std::shared_ptr<OpenZip> zip_;
  std::vector<ArchiveEntry> entries_;
  std::vector<zip_uint64_t> places_;
};

/// True if a name stays within the archive.
bool stays_within(std::string_view name) {
  if (name.starts_with('/')) return false;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (name.substr(begin, end - begin) == "..") return false;
    begin = end + 1;
  }
  return true;
}

/// The entries of the directory that are files, with their indices in it.
Result<std::unique_ptr<Archive>> list_entries(std::shared_ptr<OpenZip> zip) {
  constexpr zip_int64_t most_entries = 65'536;
  constexpr std::size_t longest_name = 1024;
  const zip_int64_t count = zip_get_num_entries(zip->zip, 0);
  if (count > most_entries)
    return Error{Errc::corrupt,
                 fmt::format("is a zip of {} entries: {} at most are read", count, most_entries)};
  std::vector<std::pair<ArchiveEntry, zip_uint64_t>> found;
  for (zip_int64_t i = 0; i < count; ++i) {
    const auto place = static_cast<zip_uint64_t>(i);
    zip_stat_t stat;
    zip_stat_init(&stat);
    if (zip_stat_index(zip->zip, place, 0, &stat) != 0 || stat.name == nullptr)
      return Error{Errc::corrupt, fmt::format("the zip's entry {} is damaged", i)};
    std::string name = plain_name(std::string_view(stat.name).substr(0, longest_name + 1));
    std::ranges::replace(name, '\\', '/');
    if (name.size() > longest_name)
      return Error{Errc::corrupt, fmt::format("the name of the zip's entry {} is longer than {}", i,
                                              longest_name)};
    if (!stays_within(name))
      return Error{Errc::corrupt,
                   fmt::format("the zip's entry {} leads out of the archive: {}", i, name)};
    if (!name.empty() && !name.ends_with('/')) found.push_back({{name, stat.size}, place});
  }
  std::ranges::stable_sort(found, {}, [](const auto& entry) { return entry.first.name; });
  std::vector<ArchiveEntry> entries;
  std::vector<zip_uint64_t> places;
  for (auto& [entry, place] : found) {
    entries.push_back(std::move(entry));
    places.push_back(place);
  }
  return std::unique_ptr<Archive>(
      std::make_unique<ZipArchive>(std::move(zip), std::move(entries), std::move(places)));
}

}  // namespace

Result<std::unique_ptr<Archive>> open_zip(std::unique_ptr<RandomBytes> bytes) {
  auto zip = std::make_shared<OpenZip>(std::move(bytes));
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* source = zip_source_function_create(ZipBytes::answer, &zip->bytes, &error);
  if (source != nullptr) {
    zip->zip = zip_open_from_source(source, ZIP_RDONLY, &error);
    if (zip->zip == nullptr) zip_source_free(source);
  }
  const std::string why = zip_error_strerror(&error);
  zip_error_fini(&error);
  if (zip->zip == nullptr)
    return Error{Errc::corrupt,
                 "is a zip archive whose directory, at its end, is missing or damaged (" + why +
                     "): fetch it again, or repair it with zip -FF"};
  return list_entries(std::move(zip));
}

}  // namespace proofmass::io
