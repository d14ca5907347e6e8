# Finds the library of Linux's industrial I/O, as Libiio::iio: with the API of 0.x, which 1.0
# replaces. It has no CMake package of its own.
find_path(Libiio_INCLUDE_DIR iio.h)
find_library(Libiio_LIBRARY NAMES iio)
mark_as_advanced(Libiio_INCLUDE_DIR Libiio_LIBRARY)

# 1.0 has its header in a folder, iio/iio.h.
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Libiio REQUIRED_VARS Libiio_LIBRARY Libiio_INCLUDE_DIR)

if(Libiio_FOUND AND NOT TARGET Libiio::iio)
  add_library(Libiio::iio UNKNOWN IMPORTED)
  set_target_properties(Libiio::iio PROPERTIES
    IMPORTED_LOCATION "${Libiio_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${Libiio_INCLUDE_DIR}")
endif()
