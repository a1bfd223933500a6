# cmake --install: programs, library, public headers, and what find_package(aspic) and pkg-config read.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# aspic_install_library(): all but the programs, which install themselves.
function(aspic_install_library)
  set(package "${CMAKE_INSTALL_LIBDIR}/cmake/aspic")
  install(TARGETS aspic_lib EXPORT aspicStaticTargets COMPONENT library ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(EXPORT aspicStaticTargets NAMESPACE aspic:: DESTINATION "${package}" COMPONENT library)
  if(TARGET aspic_shared)
    # Debian has a package for each: what programs run with, and what they are built with.
    set(runtime library)
    if(ASPIC_PACKAGES)
      set(runtime runtime)
    endif()
    install(TARGETS aspic_shared EXPORT aspicSharedTargets
            LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT ${runtime} NAMELINK_COMPONENT library)
    install(EXPORT aspicSharedTargets NAMESPACE aspic:: DESTINATION "${package}" COMPONENT library)
  endif()
  foreach(include IN ITEMS "${PROJECT_SOURCE_DIR}/include/" "${PROJECT_BINARY_DIR}/include/")
    install(DIRECTORY "${include}" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT library)
  endforeach()
  configure_package_config_file("${PROJECT_SOURCE_DIR}/cmake/aspicConfig.cmake.in" "${PROJECT_BINARY_DIR}/aspicConfig.cmake"
                                INSTALL_DESTINATION "${package}")
  write_basic_package_version_file("${PROJECT_BINARY_DIR}/aspicConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
  install(FILES "${PROJECT_BINARY_DIR}/aspicConfig.cmake" "${PROJECT_BINARY_DIR}/aspicConfigVersion.cmake" DESTINATION "${package}"
          COMPONENT library)
  # cmake --install --prefix may put it anywhere.
  file(RELATIVE_PATH up "/${CMAKE_INSTALL_LIBDIR}/pkgconfig" "/")
  configure_file("${PROJECT_SOURCE_DIR}/cmake/aspic.pc.in" "${PROJECT_BINARY_DIR}/aspic.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/aspic.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT library)
  if(NOT ASPIC_PACKAGES)  # where each package has them (AspicPackages.cmake)
    install(FILES "${PROJECT_SOURCE_DIR}/LICENSE" "${PROJECT_SOURCE_DIR}/CHANGELOG.md" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT library)
  endif()
endfunction()
