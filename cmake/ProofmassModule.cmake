include(GNUInstallDirs)
include(ProofmassUnits)
include(ProofmassTests)

# proofmass_module(NAME [TEXT] [USES modules...] [ROOMS "room: rooms" ...]
#                  HEADERS ... [UNITS "name: sources" ...] [SOURCES ...] [KERNELS ...]
#                  [TESTS ...] [SLOW_TESTS ...] [LINKS targets...] [USES_PRIVATELY targets...])
#
# One folder, one library, one test program; SLOW_TESTS form a second program, labelled slow. USES is
# the only list of the modules that this one may include, ROOMS of the subfolders that a subfolder may
# include; tools/check_layers.py checks the #include lines against both. LINKS are libraries used in headers (Eigen); USES_PRIVATELY those used only in
# .cpp files.
#
# The sources of a unit are compiled together (ProofmassUnits.cmake). SOURCES are compiled one by one,
# because they are large enough. KERNELS too, at -O3 and without fused multiply-adds: a fused one
# rounds once instead of twice, and without it every processor gives the same digits. Without errno
# square roots are vectorised. TEXT modules
# generate text and pages, for which -O1 is sufficient and halves the compile time.
function(proofmass_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "TEXT" ""
    "USES;ROOMS;HEADERS;UNITS;SOURCES;KERNELS;TESTS;SLOW_TESTS;LINKS;USES_PRIVATELY")
  set(target proofmass_${name})
  add_library(${target} STATIC ${arg_SOURCES} ${arg_KERNELS})
  add_library(proofmass::${name} ALIAS ${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${arg_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(TRANSFORM arg_USES PREPEND proofmass::)
  target_link_libraries(${target} PUBLIC ${arg_USES} ${arg_LINKS} PRIVATE ${arg_USES_PRIVATELY})
  if(arg_TEXT)
    proofmass_compile_as(${target} text)
  else()
    proofmass_compile_as(${target} numbers)
  endif()
  proofmass_units(${target} ${arg_UNITS})
  # With a precompiled header GCC uses the header's optimisation flags, not the source's.
  set_source_files_properties(${arg_KERNELS} PROPERTIES
    COMPILE_OPTIONS "-ffp-contract=off;-fno-math-errno;$<$<CONFIG:Release>:-O3>" SKIP_PRECOMPILE_HEADERS ON)
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT proofmass-static COMPONENT development
    FILE_SET HEADERS COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY PROOFMASS_MODULES ${target})
  foreach(kind IN ITEMS test slow_test)
    string(TOUPPER ${kind}s tests)
    if(PROOFMASS_TESTS AND arg_${tests})
      add_executable(${name}_${kind} ${arg_${tests}})
      target_link_libraries(${name}_${kind} PRIVATE ${target} ${arg_USES_PRIVATELY})
      set(labels)
      if(kind STREQUAL slow_test)
        set(labels LABELS slow)
      endif()
      proofmass_tests(${name}_${kind} PREFIX ${name} ${labels})
    endif()
  endforeach()
endfunction()
