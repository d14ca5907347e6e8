#include "proofmass/io/write_recording.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "proofmass/core/new_file.hpp"
#include "proofmass/io/bytes/output_file.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io {
namespace {

/// Support of a format for labels: beside the samples, or after them.
enum class LabelRoom { none, beside, after };

struct Extension {
  std::string_view ending;
  CreateWriter* create;
  LabelRoom labels = LabelRoom::none;
  bool is_compressed = false;
};
constexpr std::array extensions = std::to_array<Extension>({
    {".csv", create_csv, LabelRoom::beside},
    {".csv.gz", create_csv, LabelRoom::beside, true},
    {".npy", create_npy},
    {".mat", matlab::create},
    {".tdms", tdms::create, LabelRoom::after},
    {".h5", hdf5::create, LabelRoom::after},
    {".hdf5", hdf5::create, LabelRoom::after},
    {".mcap", mcap::create, LabelRoom::after},
    {".parquet", parquet::create, LabelRoom::after},
});

std::string all_endings() {
  std::string all;
  for (const Extension& extension : extensions)
    all += (all.empty() ? "" : ", ") + std::string(extension.ending);
  return all;
}

const Extension* extension_of(std::string_view path) {
  if (path == "-") return &extensions[0];
  const auto* found = std::ranges::find_if(
      extensions, [&](const Extension& e) { return path.ends_with(e.ending); });
  if (found != extensions.end()) return found;
  // "/dev/stdout", or the pipe of a shell's ">(command)".
  return is_special_file(std::string(path)) ? &extensions[0] : nullptr;
}

}  // namespace

Result<std::unique_ptr<RecordingWriter>> open_writer(const std::string& path,
                                                     const WriterHead& head,
                                                     const WriteOptions& options) {
  if (head.recording.channels.empty())
    return Error{Errc::too_few_samples, path + ": there is no channel to write"};
  const Extension* extension = extension_of(path);
  if (extension == nullptr)
    return Error{Errc::unsupported,
                 path + ": the extension names no format that is written: " + all_endings()};
  if (extension->create != create_csv && is_special_file(path))
    return Error{Errc::unsupported,
                 path + ": is not a regular file: only CSV can be written to it"};
  auto file = create_file(path);
  if (!file) return file.error();
  std::unique_ptr<OutputFile> output = std::move(file).value();
  if (extension->is_compressed) output = gzipped(std::move(output));
  auto writer = extension->create(std::move(output), head, options);
  if (!writer) return writer.error().at(path);
  return writer;
}

bool keeps_labels(const std::string& path, bool in_pieces) {
  const Extension* extension = extension_of(path);
  if (extension == nullptr || extension->labels == LabelRoom::none) return false;
  return extension->labels == LabelRoom::after || !in_pieces;
}

Block whole_of(const Recording& recording) {
  Block block;
  for (const Channel& channel : recording.channels) block.channels.emplace_back(channel.values);
  block.stamps_s = recording.time.stamps_s;
  return block;
}

Status write_recording(const Recording& recording,
                       const std::string& path,
                       const WriteOptions& options) {
  auto writer = open_writer(
      path, {.recording = recording, .has_stamps = !recording.time.is_uniform()}, options);
  if (!writer) return writer.error();
  if (const Status written = (*writer)->write(whole_of(recording)); !written) return written;
  return (*writer)->finish(recording);
}

}  // namespace proofmass::io
