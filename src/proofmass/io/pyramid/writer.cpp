#include <algorithm>
#include <fmt/format.h>
#include <span>
#include <sys/stat.h>
#include <utility>

#include "proofmass/io/archive/stored_zip.hpp"
#include "proofmass/io/pyramid/arrays.hpp"
#include "proofmass/io/pyramid/file.hpp"

namespace proofmass::io {
namespace {

std::string npy_head(std::string_view type, const std::string& shape) {
  std::string text =
      fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}), }}", type, shape);
  // The values begin at a multiple of 64 bytes, as the format requires, after a line end.
  text.resize((npy_magic_bytes + text.size() + 1 + 63) / 64 * 64 - npy_magic_bytes - 1, ' ');
  text += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += static_cast<char>(text.size() & 0xFF);
  out += static_cast<char>(text.size() >> 8);
  return out + text;
}

template <class T>
std::string_view bytes_of(std::span<const T> values) {
  return {reinterpret_cast<const char*>(values.data()), values.size_bytes()};
}

template <class T>
Status add_list(StoredZipWriter& zip, const std::string& name, const std::vector<T>& values) {
  return zip.add(name + ".npy", npy_head(type_of<T>(), fmt::format("{},", values.size())),
                 bytes_of(std::span<const T>(values)));
}

/// One row per channel.
template <class T>
Status add_rows(StoredZipWriter& zip,
                const std::string& name,
                const PyramidLevel& level,
                std::vector<T> PyramidChannel::* column) {
  std::vector<T> all;
  all.reserve(level.channels.size() * level.bins());
  for (const PyramidChannel& channel : level.channels)
    all.insert(all.end(), (channel.*column).begin(), (channel.*column).end());
  return zip.add(name + ".npy",
                 npy_head(type_of<T>(), fmt::format("{}, {}", level.channels.size(), level.bins())),
                 bytes_of(std::span<const T>(all)));
}

std::string in_one_field(std::string text) {
  std::ranges::replace_if(text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return text;
}

Status add_level(StoredZipWriter& zip, const PyramidLevel& level, std::size_t index) {
  const std::string place = fmt::format("{:02}_", index);
  if (const Status s = add_list(zip, place + "start_s", level.start_s); !s) return s.error();
  if (const Status s = add_rows(zip, place + "min", level, &PyramidChannel::min); !s)
    return s.error();
  if (const Status s = add_rows(zip, place + "max", level, &PyramidChannel::max); !s)
    return s.error();
  return add_rows(zip, place + "nonfinite", level, &PyramidChannel::nonfinite);
}

}  // namespace

Result<SourceState> source_state_of(const std::string& path) {
  struct stat found{};
  if (::stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode))
    return Error{Errc::unreadable, path + ": is not a file"};
  return SourceState{static_cast<std::uint64_t>(found.st_size),
                     std::int64_t{found.st_mtim.tv_sec} * 1'000'000'000 + found.st_mtim.tv_nsec};
}

std::string pyramid_path_of(const std::string& path) {
  return path + ".pyramid.npz";
}

Status write_pyramid(const Pyramid& pyramid,
                     const SourceState& source,
                     std::unique_ptr<OutputFile> file) {
  StoredZipWriter zip(std::move(file));
  std::string names;
  for (std::size_t c = 0; c < pyramid.names.size(); ++c)
    names += in_one_field(pyramid.names[c]) + '\t' + in_one_field(pyramid.units[c]) + '\n';
  if (const Status s = zip.add("names.txt", {}, names); !s) return s.error();
  const std::vector<std::int64_t> state{static_cast<std::int64_t>(source.bytes),
                                        source.modified_ns};
  std::vector<std::int64_t> bin_samples;
  for (const PyramidLevel& level : pyramid.levels)
    bin_samples.push_back(static_cast<std::int64_t>(level.bin_samples));
  const std::vector<std::int64_t> samples{static_cast<std::int64_t>(pyramid.samples)};
  for (const auto& [name, list] :
       {std::pair{"source", &state}, {"bin_samples", &bin_samples}, {"samples", &samples}})
    if (const Status s = add_list(zip, name, *list); !s) return s.error();
  if (const Status s = add_list(zip, "end_s", std::vector{pyramid.end_s}); !s) return s.error();
  for (std::size_t i = 0; i < pyramid.levels.size(); ++i)
    if (const Status s = add_level(zip, pyramid.levels[i], i); !s) return s.error();
  return zip.finish();
}

Status store_pyramid(const Pyramid& pyramid, const std::string& recording_path) {
  const auto source = source_state_of(recording_path);
  if (!source) return source.error();
  auto file = create_file(pyramid_path_of(recording_path));
  if (!file) return file.error();
  return write_pyramid(pyramid, *source, std::move(file).value());
}

}  // namespace proofmass::io
