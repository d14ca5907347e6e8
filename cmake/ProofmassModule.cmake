include(GNUInstallDirs)
include(GoogleTest)

# proofmass_module(NAME [USES modules...] HEADERS ... SOURCES ... [TESTS ...] [SLOW_TESTS ...]
#                  [LINKS targets...] [USES_PRIVATELY targets...])
#
# One folder, one library, one test program; SLOW_TESTS are a second one, labelled slow. USES is the only place that says which modules this
# one may include; tools/check_layers.py holds the #include lines to it. LINKS are libraries that
# the headers show (Eigen); USES_PRIVATELY those that only .cpp files name.
function(proofmass_module name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "USES;HEADERS;SOURCES;TESTS;SLOW_TESTS;LINKS;USES_PRIVATELY")
  set(target proofmass_${name})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(proofmass::${name} ALIAS ${target})
  target_sources(${target} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/src FILES ${arg_HEADERS})
  target_compile_features(${target} PUBLIC cxx_std_20)
  list(TRANSFORM arg_USES PREPEND proofmass::)
  target_link_libraries(${target} PUBLIC ${arg_USES} ${arg_LINKS} PRIVATE ${arg_USES_PRIVATELY})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  install(TARGETS ${target} EXPORT proofmass-static COMPONENT development
    FILE_SET HEADERS COMPONENT development)
  set_property(GLOBAL APPEND PROPERTY PROOFMASS_MODULES ${target})
  foreach(kind IN ITEMS test slow_test)
    string(TOUPPER ${kind}s tests)
    if(PROOFMASS_TESTS AND arg_${tests})
      add_executable(${name}_${kind} ${arg_${tests}})
      target_link_libraries(${name}_${kind}
        PRIVATE ${target} ${arg_USES_PRIVATELY} GTest::gtest_main)
      target_compile_definitions(${name}_${kind}
        PRIVATE PROOFMASS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
      set(labels)
      if(kind STREQUAL slow_test)
        set(labels PROPERTIES LABELS slow)
      endif()
      gtest_discover_tests(${name}_${kind} TEST_PREFIX ${name}. DISCOVERY_TIMEOUT 60 ${labels})
    endif()
  endforeach()
endfunction()
