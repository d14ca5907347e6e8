#include "proofmass/io/bytes/crc32.hpp"

#include <zlib.h>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define PM_CARRYLESS __attribute__((target("pclmul,sse4.1")))
#endif

namespace proofmass::io {
namespace {

std::uint32_t crc32_of_zlib(std::uint32_t so_far, std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(so_far, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

#if defined(PM_CARRYLESS)

/// `folded` shifted by the number of bits given by the two constants, with the next bytes added.
PM_CARRYLESS __m128i fold(__m128i folded, __m128i constants, __m128i next) {
  const __m128i low = _mm_clmulepi64_si128(folded, constants, 0x00);
  const __m128i high = _mm_clmulepi64_si128(folded, constants, 0x11);
  return _mm_xor_si128(_mm_xor_si128(low, high), next);
}

PM_CARRYLESS __m128i load(const char* bytes) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes));
}

/// Folds 64 bytes at a time into 16 bytes with the same remainder, which zlib then divides.
PM_CARRYLESS std::uint32_t crc32_by_folding(std::uint32_t so_far, std::string_view bytes) {
  // Remainders of x^(512+32), x^(512-32) and x^(128+32), x^(128-32), bits reflected (ibid., table).
  const __m128i by_512 = _mm_set_epi64x(0x1c6e41596, 0x154442bd4);
  const __m128i by_128 = _mm_set_epi64x(0x0ccaa009e, 0x1751997d0);
  const char* at = bytes.data();
  std::size_t left = bytes.size();
  __m128i a = _mm_xor_si128(load(at), _mm_cvtsi32_si128(static_cast<int>(~so_far)));
  __m128i b = load(at + 16);
  __m128i c = load(at + 32);
  __m128i d = load(at + 48);
  for (at += 64, left -= 64; left >= 64; at += 64, left -= 64) {
    a = fold(a, by_512, load(at));
    b = fold(b, by_512, load(at + 16));
    c = fold(c, by_512, load(at + 32));
    d = fold(d, by_512, load(at + 48));
  }
  a = fold(fold(fold(a, by_128, b), by_128, c), by_128, d);
  for (; left >= 16; at += 16, left -= 16) a = fold(a, by_128, load(at));
  alignas(16) char rest[16];
  _mm_store_si128(reinterpret_cast<__m128i*>(rest), a);
  // An initial value of all ones means no preceding bits: the register is already in `rest`.
  return crc32_of_zlib(crc32_of_zlib(0xFFFFFFFFu, {rest, 16}), {at, left});
}

#endif

}  // namespace

std::uint32_t crc32(std::uint32_t so_far, std::string_view bytes) {
#if defined(PM_CARRYLESS)
  if (bytes.size() >= 256 && __builtin_cpu_supports("pclmul") != 0 &&
      __builtin_cpu_supports("sse4.1") != 0)
    return crc32_by_folding(so_far, bytes);
#endif
  return crc32_of_zlib(so_far, bytes);
}

}  // namespace proofmass::io
