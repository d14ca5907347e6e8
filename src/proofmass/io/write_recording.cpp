#include "proofmass/io/write_recording.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>
#include <zlib.h>

#include "proofmass/io/recording_writers.hpp"

namespace proofmass::io {
namespace {

using Write = bool (*)(const Recording&, const Sink&);

struct Extension {
  std::string_view ending;
  Write write;
  bool compressed;
};
constexpr std::array extensions = std::to_array<Extension>({
    {".csv", write_csv, false},
    {".csv.gz", write_csv, true},
    {".npy", write_npy, false},
});

Error cannot_write(const std::string& path) {
  return Error{Errc::unreadable,
               path + ": cannot be written: " + std::generic_category().message(errno)};
}

bool write_plain(const Recording& recording, Write write, const std::string& path) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return false;
  const bool written = write(recording, [&](std::string_view bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  });
  return (std::fclose(file) == 0) && written;
}

bool write_gzip(const Recording& recording, Write write, const std::string& path) {
  gzFile file = gzopen(path.c_str(), "wb6");
  if (file == nullptr) return false;
  const bool written = write(recording, [&](std::string_view bytes) {
    return bytes.empty() || gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size())) > 0;
  });
  return (gzclose(file) == Z_OK) && written;
}

bool write_standard_output(const Recording& recording) {
  const bool written = write_csv(recording, [](std::string_view bytes) {
    return std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size();
  });
  return std::fflush(stdout) == 0 && written;
}

}  // namespace

Status write_recording(const Recording& recording, const std::string& path) {
  if (recording.channels.empty())
    return Error{Errc::too_few_samples, path + ": there is no channel to write"};
  if (path == "-")
    return write_standard_output(recording) ? Status(Done{}) : cannot_write("standard output");
  const auto extension = std::ranges::find_if(
      extensions, [&](const Extension& e) { return path.ends_with(e.ending); });
  if (extension == extensions.end())
    return Error{Errc::unsupported,
                 path + ": the extension names no format that is written: .csv, .csv.gz, .npy"};
  const std::string part = path + ".part";
  const bool written = extension->compressed ? write_gzip(recording, extension->write, part)
                                             : write_plain(recording, extension->write, part);
  if (!written) {
    Error error = cannot_write(path);
    std::remove(part.c_str());
    return error;
  }
  std::error_code problem;
  std::filesystem::rename(part, path, problem);
  if (problem) {
    std::remove(part.c_str());
    return Error{Errc::unreadable, path + ": cannot be written: " + problem.message()};
  }
  return Done{};
}

}  // namespace proofmass::io
