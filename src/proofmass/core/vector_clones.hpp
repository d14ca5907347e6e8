#pragma once

/// Before a function's definition: compiles it for the vector units of several processors, of which
/// one is chosen when the program starts. Where that cannot be done, nothing. The file has to be
/// compiled with -ffp-contract=off, so that every processor gets the same digits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define PM_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define PM_VECTOR_CLONES
#endif
