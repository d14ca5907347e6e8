// Replaces the HDF5 library if it was not available at build time.
#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io::hdf5 {
namespace {

Error absent() {
  return {Errc::unsupported, "is HDF5, and this program was built without the HDF5 library"};
}

}  // namespace

bool has_library() {
  return false;
}

Result<Catalogue> list_datasets(const Source&, bool) {
  return absent();
}

Status read_values(const Source&, const std::vector<Request>&, const ByteSink&) {
  return absent();
}

Result<std::unique_ptr<RecordingWriter>> create(std::unique_ptr<OutputFile>,
                                                const WriterHead&,
                                                const WriteOptions&) {
  return Error{Errc::unsupported,
               "HDF5 is not written: this program was built without the HDF5 library"};
}

}  // namespace proofmass::io::hdf5
