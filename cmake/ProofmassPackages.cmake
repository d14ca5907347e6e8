# Libraries that bring a file for pkg-config and no CMake package that could be used (libzip's asks
# for its tools too): NAME_FOUND and PkgConfig::NAME. Used by the build and by those who link the
# installed static libraries.
find_package(PkgConfig QUIET)
function(proofmass_package name module)
  if(PkgConfig_FOUND AND NOT TARGET PkgConfig::${name})
    pkg_check_modules(${name} QUIET IMPORTED_TARGET GLOBAL ${module})
  endif()
  if(TARGET PkgConfig::${name})
    set(${name}_FOUND TRUE PARENT_SCOPE)
  endif()
endfunction()
proofmass_package(LibZip libzip)
proofmass_package(Lz4 liblz4)
proofmass_package(Zstd libzstd)
proofmass_package(Deflate libdeflate)
proofmass_package(Libiio "libiio<1") # 1.0 has another interface
proofmass_package(Comedi comedilib)
