# libproofmass.so: every module's objects, as compiled for the static libraries. Its users need none
# of the modules' private dependencies.
get_property(modules GLOBAL PROPERTY PROOFMASS_MODULES)
list(TRANSFORM modules REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
add_library(proofmass_shared SHARED ${objects})
add_library(proofmass::proofmass ALIAS proofmass_shared)
# While the version is 0.x, each minor version may break binary compatibility.
set_target_properties(proofmass_shared PROPERTIES
  LINKER_LANGUAGE CXX
  OUTPUT_NAME proofmass
  EXPORT_NAME proofmass
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/proofmass.map)
foreach(module IN LISTS modules)
  get_target_property(libraries ${module} LINK_LIBRARIES)
  list(FILTER libraries EXCLUDE REGEX "^proofmass::")
  target_link_libraries(proofmass_shared PRIVATE ${libraries})
endforeach()
target_link_libraries(proofmass_shared PUBLIC Eigen3::Eigen)
# Symbols from third-party headers are not exported.
target_link_options(proofmass_shared PRIVATE
  -Wl,--as-needed -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/proofmass.map)
target_compile_features(proofmass_shared PUBLIC cxx_std_20)
target_include_directories(proofmass_shared INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS proofmass_shared EXPORT proofmass
  LIBRARY COMPONENT library NAMELINK_COMPONENT development)
