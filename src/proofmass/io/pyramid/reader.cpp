#include <cstring>
#include <fmt/format.h>
#include <map>
#include <span>
#include <utility>

#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/numpy/npy_header.hpp"
#include "proofmass/io/pyramid/arrays.hpp"
#include "proofmass/io/pyramid/file.hpp"

namespace proofmass::io {
namespace {

Error damaged(std::string_view what) {
  return {Errc::corrupt,
          fmt::format("is not a pyramid of Proofmass, or a damaged one ({}): delete it", what)};
}

/// The entries of an archive that is a pyramid.
class PyramidReader {
 public:
  PyramidReader(std::unique_ptr<Archive> archive, std::uint64_t file_bytes)
      : archive_(std::move(archive)), file_bytes_(file_bytes) {
    for (std::size_t i = 0; i < archive_->entries().size(); ++i)
      places_.emplace(archive_->entries()[i].name, i);
  }

  /// All bytes of an entry, which is uncompressed: no entry exceeds the archive's size.
  Result<std::string> text(const std::string& name) const {
    const auto at = places_.find(name);
    if (at == places_.end()) return damaged("has no " + name);
    const std::uint64_t size = archive_->entries()[at->second].size;
    if (size > file_bytes_) return damaged(name + " is longer than the file");
    auto source = archive_->open(at->second);
    if (!source) return source.error();
    std::string out(size, '\0');
    for (std::size_t filled = 0; filled < out.size();) {
      const auto count = (*source)->read(std::span(out).subspan(filled));
      if (!count) return count.error();
      if (*count == 0) return damaged(name + " breaks off");
      filled += *count;
    }
    return out;
  }

  /// A list or table with this total number of values.
  template <class T>
  Result<std::vector<T>> figures(const std::string& name, std::size_t count) const {
    const auto bytes = text(name + ".npy");
    if (!bytes) return bytes.error();
    if (bytes->size() < npy_magic_bytes || !bytes->starts_with("\x93NUMPY\x01"))
      return damaged(name);
    const auto low = static_cast<unsigned char>((*bytes)[8]);
    const auto high = static_cast<unsigned char>((*bytes)[9]);
    const std::size_t begin = npy_magic_bytes + low + 256U * high;
    if (begin > bytes->size()) return damaged(name);
    const auto header =
        read_npy_header(std::string_view(*bytes).substr(npy_magic_bytes, begin - npy_magic_bytes));
    if (!header || header->is_structured || header->fortran_order) return damaged(name);
    const FigureType& type = header->fields.front().type;
    const std::string_view wanted = type_of<T>();
    if (type.kind != wanted[1] || type.bytes != sizeof(T) || type.big_endian) return damaged(name);
    if ((bytes->size() - begin) / sizeof(T) != count || (bytes->size() - begin) % sizeof(T) != 0)
      return damaged(name + " is not as long as it should be");
    std::vector<T> out(count);
    if (count > 0) std::memcpy(out.data(), bytes->data() + begin, count * sizeof(T));
    return out;
  }

  /// One row per channel, distributed to the channels.
  template <class T>
  Status rows(const std::string& name,
              PyramidLevel& level,
              std::vector<T> PyramidChannel::* column) const {
    const std::size_t bins = level.bins();
    const auto all = figures<T>(name, level.channels.size() * bins);
    if (!all) return all.error();
    for (std::size_t c = 0; c < level.channels.size(); ++c) {
      const auto begin = all->begin() + static_cast<std::ptrdiff_t>(c * bins);
      (level.channels[c].*column).assign(begin, begin + static_cast<std::ptrdiff_t>(bins));
    }
    return Done{};
  }

 private:
  std::unique_ptr<Archive> archive_;
  std::uint64_t file_bytes_;
  std::map<std::string, std::size_t> places_;
};

/// "name TAB unit" per line.
Status read_names(const PyramidReader& reader, Pyramid& out) {
  const auto text = reader.text("names.txt");
  if (!text) return text.error();
  for (std::string_view rest = *text; !rest.empty();) {
    const std::size_t end = rest.find('\n');
    const std::size_t tab = rest.find('\t');
    if (end == std::string_view::npos || tab == std::string_view::npos || tab > end)
      return damaged("names.txt");
    out.names.emplace_back(rest.substr(0, tab));
    out.units.emplace_back(rest.substr(tab + 1, end - tab - 1));
    rest.remove_prefix(end + 1);
  }
  return Done{};
}

Status read_level(const PyramidReader& reader, std::size_t index, Pyramid& out) {
  const std::string place = fmt::format("{:02}_", index);
  std::uint64_t bin_samples = PyramidBuilder::finest_bin;
  for (std::size_t i = 0; i < index; ++i) bin_samples *= PyramidBuilder::factor;
  const std::uint64_t bins = out.samples / bin_samples + (out.samples % bin_samples > 0 ? 1 : 0);
  PyramidLevel level{bin_samples, {}, {}};
  auto start_s = reader.figures<double>(place + "start_s", bins);
  if (!start_s) return start_s.error();
  level.start_s = std::move(start_s).value();
  level.channels.resize(out.names.size());
  if (const Status s = reader.rows(place + "min", level, &PyramidChannel::min); !s)
    return s.error();
  if (const Status s = reader.rows(place + "max", level, &PyramidChannel::max); !s)
    return s.error();
  if (const Status s = reader.rows(place + "nonfinite", level, &PyramidChannel::nonfinite); !s)
    return s.error();
  out.levels.push_back(std::move(level));
  return Done{};
}

}  // namespace

Result<Pyramid> read_pyramid(std::unique_ptr<RandomBytes> bytes, const SourceState& source) {
  const std::uint64_t file_bytes = bytes->size();
  auto archive = open_zip(std::move(bytes));
  if (!archive) return archive.error();
  return read_pyramid(std::move(archive).value(), file_bytes, source);
}

Result<Pyramid> read_pyramid(std::unique_ptr<Archive> archive,
                             std::uint64_t file_bytes,
                             const SourceState& source) {
  const PyramidReader reader(std::move(archive), file_bytes);
  const auto state = reader.figures<std::int64_t>("source", 2);
  if (!state) return state.error();
  if ((*state)[0] != static_cast<std::int64_t>(source.bytes) || (*state)[1] != source.modified_ns)
    return Error{Errc::unsupported, "was built from another version of the recording: rebuild it"};
  Pyramid out;
  if (const Status s = read_names(reader, out); !s) return s.error();
  const auto samples = reader.figures<std::int64_t>("samples", 1);
  if (!samples) return samples.error();
  const auto end_s = reader.figures<double>("end_s", 1);
  if (!end_s) return end_s.error();
  out.end_s = end_s->front();
  if (samples->front() < 1 || !(out.end_s >= 0.0)) return damaged("samples");
  out.samples = static_cast<std::uint64_t>(samples->front());
  do {
    if (const Status s = read_level(reader, out.levels.size(), out); !s) return s.error();
  } while (out.levels.back().bins() > PyramidBuilder::factor);
  return out;
}

Result<Pyramid> read_pyramid(const std::string& recording_path) {
  const std::string path = pyramid_path_of(recording_path);
  const auto source = source_state_of(recording_path);
  if (!source) return source.error();
  auto file = open_file(path);
  if (!file) return file.error().at(path);
  auto bytes = random_bytes_of(std::make_unique<PeekSource>(std::move(file).value()), {});
  if (!bytes) return bytes.error().at(path);
  auto pyramid = read_pyramid(std::move(bytes).value(), *source);
  return pyramid ? std::move(pyramid) : Result<Pyramid>(pyramid.error().at(path));
}

}  // namespace proofmass::io
