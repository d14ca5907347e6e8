#include "proofmass/io/read_recording.hpp"

#include <algorithm>
#include <new>

#include "proofmass/io/byte_source.hpp"
#include "proofmass/io/formats.hpp"

namespace proofmass::io {
namespace {

Result<Recording> read_from(std::unique_ptr<ByteSource> bytes,
                            const std::string& name,
                            const ReadOptions& options) {
  auto source = unwrap(std::move(bytes));
  if (!source) return source.error();
  const std::unique_ptr<PeekSource> opened = std::move(source).value();
  const auto head = opened->peek(4096);
  if (!head) return head.error();
  const auto all = formats();
  const auto format =
      std::ranges::find_if(all, [&](const Format& f) { return f.claims(*head, name); });
  if (!options.variables.empty() && !format->has_variables)
    return Error{Errc::invalid_argument,
                 "has no datasets to choose from: --dataset and --variable are for HDF5 and MAT "
                 "files"};
  return format->read(*opened, options);
}

Result<Recording> named(Result<Recording> read, const std::string& name) {
  if (!read) return read.error().at(name == "-" ? "standard input" : name);
  Recording recording = std::move(read).value();
  recording.source = name;
  return recording;
}

}  // namespace

Result<Recording> read_recording(const std::string& path, const ReadOptions& options) try {
  auto file = open_file(path);
  if (!file) return file.error().at(path);
  return named(read_from(std::move(file).value(), path, options), path);
} catch (const std::bad_alloc&) {
  return Error{Errc::unreadable, "does not fit into memory: cut it, or choose channels"}.at(path);
}

Result<Recording> read_recording(std::span<const std::byte> bytes,
                                 const std::string& name,
                                 const ReadOptions& options) {
  return named(read_from(open_memory(bytes), name, options), name);
}

}  // namespace proofmass::io
