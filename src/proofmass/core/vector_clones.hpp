#pragma once

/// Placed before a function's definition: compiles it for the vector units of several processors,
/// one of which is selected when the program starts. Empty where this is not supported. The file
/// must be compiled with -ffp-contract=off, so that every processor gives the same digits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define PM_VECTOR_CLONES __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define PM_VECTOR_CLONES
#endif
