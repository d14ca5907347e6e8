// Replaces operator new of the command and of the Python module, so that memory of long recordings
// is in huge pages where the system offers them on request (Linux: transparent_hugepage = madvise).
// The first access to each page interrupts the program, which for pages of 4 KiB takes longer than
// a pass over the samples: a recording of 58 MB has 14 000 of them, or 28 huge ones. The libraries
// do not contain this: a library must not replace the allocation of its users.
#include <cstddef>
#include <cstdlib>
#include <new>

#if defined(__linux__) && defined(__GLIBC__)
#include <sys/mman.h>

namespace {

constexpr std::size_t huge_page = std::size_t{2} << 20;

void* allocated(std::size_t size) {
  if (size < huge_page) return std::malloc(size > 0 ? size : 1);
  void* memory = nullptr;
  if (::posix_memalign(&memory, huge_page, size) != 0) return nullptr;
  // Advice only: without huge pages, and in the last part of one, the memory is as usual.
  ::madvise(memory, size, MADV_HUGEPAGE);
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  while (true) {
    if (void* memory = allocated(size)) return memory;
    const std::new_handler handler = std::get_new_handler();
    if (handler == nullptr) throw std::bad_alloc();
    handler();
  }
}

void operator delete(void* memory) noexcept {
  std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

#endif
