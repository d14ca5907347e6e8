// Replaces the HDF5 library if it was not available at build time.
#include "proofmass/io/hdf5/library.hpp"
#include "proofmass/io/reading/recording_writers.hpp"

namespace proofmass::io {
namespace {

Error absent() {
  return {Errc::unsupported, "is HDF5, and this program was built without the HDF5 library"};
}

}  // namespace

bool has_hdf5_library() {
  return false;
}

Result<Hdf5Catalogue> list_hdf5(const Hdf5Source&, bool) {
  return absent();
}

Status read_hdf5(const Hdf5Source&, const std::vector<Hdf5Request>&, const ByteSink&) {
  return absent();
}

Result<std::unique_ptr<RecordingWriter>> hdf5_writer(std::unique_ptr<OutputFile>,
                                                     const WriterHead&,
                                                     const WriteOptions&) {
  return Error{Errc::unsupported,
               "HDF5 is not written: this program was built without the HDF5 library"};
}

}  // namespace proofmass::io
