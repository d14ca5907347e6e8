# The Debian packages, by CPack. A package for another release, or for Ubuntu, is built there: what it
# depends on is found in the libraries that it was linked with.
find_program(GZIP gzip)
mark_as_advanced(GZIP)
if(NOT GZIP)
  message(STATUS "No Debian packages: they need gzip")
  return()
endif()
set(PROOFMASS_MAINTAINER "The Proofmass authors <authors@proofmass.invalid>"
  CACHE STRING "Who answers for the packages: NAME <MAIL>")
set(revision 1)
set(library_package libproofmass${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(program_package proofmass)
set(development_package libproofmass-dev)
set(python_package python3-proofmass)
set(parts library program development)
if(PROOFMASS_HAS_PYTHON)
  list(APPEND parts python)
endif()

# A package tells whose it is and since when, in files that nothing else installs.
file(TIMESTAMP ${PROJECT_SOURCE_DIR}/CHANGELOG.md date "%a, %d %b %Y %H:%M:%S +0000" UTC)
configure_file(changelog.Debian.in changelog.Debian @ONLY)
execute_process(COMMAND ${GZIP} -9nkf ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian
  COMMAND_ERROR_IS_FATAL ANY)
foreach(part IN LISTS parts)
  install(FILES copyright ${CMAKE_CURRENT_BINARY_DIR}/changelog.Debian.gz
    DESTINATION share/doc/${${part}_package} COMPONENT debian_${part} EXCLUDE_FROM_ALL)
endforeach()

# What the static libraries are linked with, of the packages that this build needed.
file(STRINGS ${PROJECT_SOURCE_DIR}/tools/packages.txt needed REGEX "^(run|more) .*-dev$")
list(TRANSFORM needed REPLACE "^[a-z]+ +" "")
list(REMOVE_ITEM needed libeigen3-dev libcli11-dev libfast-float-dev pybind11-dev python3-dev)
list(JOIN needed ", " needed)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CONTACT "${PROOFMASS_MAINTAINER}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package has its own
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 0)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${revision})
set(CPACK_DEBIAN_PACKAGE_SOURCE proofmass)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SHLIBDEPS ON)
file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/triggers)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION
"accelerometer readings to angle and position, shared library
Reads recordings of accelerometers in the formats of loggers, cards and
phones, tells what their noise, drift and calibration are, and estimates
angle, turns, speed and displacement with standard deviations.
.
This is the library that other programs are linked with.")

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME ${program_package})
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
"accelerometer readings to angle and position with honest error bars
Turns the readings of an accelerometer into angle, turns, speed and
displacement, and says how far each can be trusted; finds noise, warm-up and
calibration of the sensor from recordings at rest; records from devices,
networks and phones.
.
Results are text, JSON, and pages of plots that need nothing but a browser.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME ${development_package})
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
  "${library_package} (= ${PROJECT_VERSION}-${revision}), libeigen3-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "${needed}")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
"accelerometer readings to angle and position, C++ headers
Headers, CMake package and examples of libproofmass, and its modules as
static libraries.
.
The shared library asks for Eigen alone; the static ones for the packages
that are recommended.")

if(PROOFMASS_HAS_PYTHON)
  # The extension is built for one version of the interpreter.
  math(EXPR next_minor "${PROOFMASS_PYTHON_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME ${python_package})
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${PROOFMASS_PYTHON_MINOR}), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-pandas, python3-matplotlib, python3-tqdm")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION
"accelerometer readings to angle and position, Python module
Reads recordings of accelerometers, finds noise, drift and calibration, and
estimates angle, turns, speed and displacement with standard deviations, of
NumPy arrays and pandas tables; Allan deviations with limits and Kalman
smoothers as tools of their own.")
endif()

# Not the licence, which Debian has already.
set(CPACK_COMPONENTS_ALL ${parts})
foreach(part IN LISTS parts)
  list(APPEND CPACK_COMPONENTS_ALL debian_${part})
endforeach()
include(CPack)
foreach(part IN LISTS parts)
  cpack_add_component_group(${part})
  cpack_add_component(${part} GROUP ${part})
  cpack_add_component(debian_${part} GROUP ${part})
endforeach()
