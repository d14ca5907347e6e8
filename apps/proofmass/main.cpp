#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "cli/console.hpp"
#include "cli/run_command.hpp"

int main(int argc, char** argv) {
#ifdef __GLIBC__
  // A threshold that has been set is not raised when memory is freed: the columns of a long
  // recording then go back to the system.
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
#endif
  proofmass::app::watch_for_interrupts();
  return proofmass::app::run_command(argc, argv);
}
