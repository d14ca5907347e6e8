# Finds the library of the comedi drivers, as Comedi::comedi: it has no CMake package of its own.
find_path(Comedi_INCLUDE_DIR comedilib.h)
find_library(Comedi_LIBRARY NAMES comedi)
mark_as_advanced(Comedi_INCLUDE_DIR Comedi_LIBRARY)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Comedi REQUIRED_VARS Comedi_LIBRARY Comedi_INCLUDE_DIR)

if(Comedi_FOUND AND NOT TARGET Comedi::comedi)
  add_library(Comedi::comedi UNKNOWN IMPORTED)
  set_target_properties(Comedi::comedi PROPERTIES
    IMPORTED_LOCATION "${Comedi_LIBRARY}"
    INTERFACE_INCLUDE_DIRECTORIES "${Comedi_INCLUDE_DIR}")
endif()
