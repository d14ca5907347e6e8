# How sources are compiled: one at a time would be slow, because parsing headers and instantiating
# their templates takes the compiler more time than the sources themselves.
option(PROOFMASS_UNITS "Compile sources that belong together as one" ON)
if(PROOFMASS_UNITS AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  # A class defined in a source may have private members of a type local to that source; GCC treats
  # the unit as the source and the source as a header, and warns.
  add_compile_options(-Wno-subobject-linkage)
endif()
option(PROOFMASS_PRECOMPILED_HEADERS "Read the headers that most sources include once" ON)
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  set(PROOFMASS_PRECOMPILED_HEADERS OFF) # Clang requires all macros to be equal
endif()

# Compiles programs like the libraries, so that they can share precompiled headers.
set(CMAKE_CXX_COMPILE_OPTIONS_PIE ${CMAKE_CXX_COMPILE_OPTIONS_PIC})

# proofmass_precompiled(KIND FLAGS LIBRARIES HEADERS...): the common headers of sources of a kind. GCC
# ignores a precompiled header, with a warning, if a source has other macros defined: the libraries
# are those whose headers are in it, and every target of the kind has to link them.
function(proofmass_precompiled kind flags libraries)
  set_property(GLOBAL PROPERTY PROOFMASS_FLAGS_${kind} "$<$<CONFIG:Release>:${flags}>")
  if(PROOFMASS_PRECOMPILED_HEADERS)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${kind}.cpp CONTENT "")
    add_library(proofmass_precompiled_${kind} OBJECT ${PROJECT_BINARY_DIR}/precompiled/${kind}.cpp)
    target_compile_features(proofmass_precompiled_${kind} PUBLIC cxx_std_20)
    target_compile_options(proofmass_precompiled_${kind} PRIVATE "$<$<CONFIG:Release>:${flags}>")
    target_link_libraries(proofmass_precompiled_${kind} PRIVATE ${libraries})
    list(TRANSFORM ARGN REPLACE "^[a-zA-Z/_.]+$" "<\\0>")
    target_precompile_headers(proofmass_precompiled_${kind} PRIVATE ${ARGN})
  endif()
endfunction()

# proofmass_compile_as(TARGET KIND): with that kind's precompiled headers and optimisation. The two go
# together: the optimisation flags stored in a precompiled header override those on GCC's command line.
function(proofmass_compile_as target kind)
  get_property(flags GLOBAL PROPERTY PROOFMASS_FLAGS_${kind})
  target_compile_options(${target} PRIVATE ${flags})
  if(PROOFMASS_PRECOMPILED_HEADERS)
    target_precompile_headers(${target} REUSE_FROM proofmass_precompiled_${kind})
  endif()
endfunction()

# proofmass_units(TARGET "name: sources" ...): adds sources, each unit compiled as one. Local names of
# a source must be unique in the unit; tools/check_layers.py checks this.
function(proofmass_units target)
  foreach(unit IN LISTS ARGN)
    if(NOT unit MATCHES "^([a-z0-9_]+): +([a-z0-9_./ \n]+)$")
      message(FATAL_ERROR "${target}: expected \"name: sources\", got \"${unit}\"")
    endif()
    set(name ${CMAKE_MATCH_1})
    string(REGEX REPLACE "[ \n]+" ";" sources "${CMAKE_MATCH_2}")
    target_sources(${target} PRIVATE ${sources})
    set_source_files_properties(${sources} PROPERTIES UNITY_GROUP ${name})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${PROOFMASS_UNITS} UNITY_BUILD_MODE GROUP)
endfunction()

set(standard algorithm array bit charconv cmath cstddef cstdint cstring filesystem functional
  iterator limits map memory numbers numeric optional random span string string_view utility vector)
proofmass_precompiled(numbers -O2 Eigen3::Eigen ${standard} Eigen/Core)
proofmass_precompiled(text -O1 "Eigen3::Eigen;fmt::fmt" ${standard} Eigen/Core fmt/format.h)
if(PROOFMASS_TESTS)
  proofmass_precompiled(test -O1 "Eigen3::Eigen;GTest::gtest" ${standard} Eigen/Core gtest/gtest.h)
endif()
