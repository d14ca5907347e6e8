#include "proofmass/io/nameless_file.hpp"

#include <cstdlib>
#include <fcntl.h>
#include <unistd.h>

namespace proofmass::io {

int nameless_file(const std::string& folder) {
  const int nameless = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (nameless >= 0) return nameless;
  // Not every file system has files without a name.
  std::string path = folder + "/proofmass-XXXXXX";
  const int named = ::mkostemp(path.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(path.c_str());
  return named;
}

}  // namespace proofmass::io
