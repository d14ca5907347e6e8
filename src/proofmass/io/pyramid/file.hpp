#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "proofmass/core/result.hpp"
#include "proofmass/io/archive/archive.hpp"
#include "proofmass/io/bytes/output_file.hpp"
#include "proofmass/io/bytes/random_bytes.hpp"
#include "proofmass/io/pyramid.hpp"

namespace proofmass::io {

/// Identifies the state of the file from which a pyramid was built.
struct SourceState {
  std::uint64_t bytes = 0;
  std::int64_t modified_ns = 0;  ///< on the file system's clock
  friend bool operator==(const SourceState&, const SourceState&) = default;
};
/// Errors: unreadable (no such file, not a regular one).
[[nodiscard]] Result<SourceState> source_state_of(const std::string& path);

/// "<path>.pyramid.npz", beside the recording.
[[nodiscard]] std::string pyramid_path_of(const std::string& path);

/// Writes a pyramid as an .npz for numpy.load:
///
/// - for level L = 0, 1, … "LL_start_s" (bins), "LL_min", "LL_max" (channels × bins, float64) and
///   "LL_nonfinite" (uint32), LL with two digits;
/// - "bin_samples" (levels), "samples", "end_s", "source" (bytes, modified_ns);
/// - "names.txt", one line "name TAB unit" per channel.
///
/// Source: PKWARE, APPNOTE.TXT 6.3.10, sections 4.3 and 4.4; NumPy Enhancement Proposal 1.
/// Errors: those of the file; unsupported (4 GiB or more).
[[nodiscard]] Status write_pyramid(const Pyramid& pyramid,
                                   const SourceState& source,
                                   std::unique_ptr<OutputFile> file);

/// Reads the output of write_pyramid(). Errors: corrupt, unreadable; unsupported (built from
/// another state of the recording, so that it has to be rebuilt).
[[nodiscard]] Result<Pyramid> read_pyramid(std::unique_ptr<RandomBytes> bytes,
                                           const SourceState& source);
/// The same for an open archive in a file of the given size.
[[nodiscard]] Result<Pyramid> read_pyramid(std::unique_ptr<Archive> archive,
                                           std::uint64_t file_bytes,
                                           const SourceState& source);

}  // namespace proofmass::io
