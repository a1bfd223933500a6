# Debian packages by CPack: what scripts/package.sh makes with the preset package. The components of an installation are
#   programs  aspic            all programs, manual pages, completion, desktop entry, icon, documents
#   runtime   libaspic0.3      the shared library, named by its soname
#   library   libaspic-dev     headers, static library, CMake package, pkg-config file
#   python    python3-aspic    the module for the distribution's own Python

file(STRINGS /etc/os-release os_release REGEX "^VERSION_(ID|CODENAME)=")
string(REGEX REPLACE ".*VERSION_ID=\"?([0-9]+).*" "\\1" debian "${os_release}")
string(REGEX REPLACE ".*VERSION_CODENAME=\"?([a-z]+).*" "\\1" codename "${os_release}")
set(release "1~deb${debian}")
set(version "${PROJECT_VERSION}-${release}")
set(soname_package "libaspic${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}")
set(contact "The Aspic authors <aspic@packages.invalid>")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME aspic)
set(CPACK_PACKAGE_VENDOR "The Aspic authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each package has its own
set(CPACK_PACKAGE_DIRECTORY "${PROJECT_BINARY_DIR}/packages")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL programs runtime library python)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "${contact}")
set(CPACK_DEBIAN_PACKAGE_RELEASE "${release}")
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Where dpkg-shlibdeps finds libaspic.so, which no installed package has.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS "${PROJECT_BINARY_DIR}")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_POST_BUILD_SCRIPTS "${PROJECT_SOURCE_DIR}/cmake/debian/without_ldconfig.cmake")

# EGL is loaded when a device is asked for: everything else works without it.
set(device "libegl1, libgl1-mesa-dri")

# aspic_package(COMPONENT NAME SECTION section DESCRIPTION text [DEPENDS …] [RECOMMENDS …] [SUGGESTS …] [CONTROL file …] [LICENCES NAME=FILE …]):
# a package of a component, with its copyright and changelogs. LICENCES are those of other people's work in its binaries.
macro(aspic_package component name)
  cmake_parse_arguments(arg "" "SECTION;DESCRIPTION;DEPENDS;RECOMMENDS;SUGGESTS" "CONTROL;LICENCES" ${ARGN})
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${arg_SECTION})
  set(CPACK_DEBIAN_${upper}_DESCRIPTION "${arg_DESCRIPTION}")
  foreach(field IN ITEMS DEPENDS RECOMMENDS SUGGESTS)
    set(CPACK_DEBIAN_${upper}_PACKAGE_${field} "${arg_${field}}")
  endforeach()
  set(CPACK_DEBIAN_${upper}_PACKAGE_CONTROL_EXTRA "${arg_CONTROL}")
  aspic_package_documents(${component} ${name} "${arg_LICENCES}")
endmacro()

# Text as a field of a control file: each line is indented, an empty one is a dot.
function(aspic_control_text result file)
  file(READ "${file}" text)
  string(STRIP "${text}" text)
  string(REGEX REPLACE "[ \t]+\n" "\n" text "${text}")
  string(REGEX REPLACE "\nFiles: debian/[^\n]*(\n[^\n]+)*" "" text "${text}")  # packaging, which is no part of ours
  string(REPLACE "\n" "\n " text " ${text}")
  string(REGEX REPLACE "\n \n" "\n .\n" text "${text}")
  string(REGEX REPLACE "\n \n" "\n .\n" text "${text}")
  set(${result} "${text}" PARENT_SCOPE)
endfunction()

function(aspic_package_documents component name licenses)
  set(folder "${PROJECT_BINARY_DIR}/debian/${name}")
  aspic_control_text(mit "${PROJECT_SOURCE_DIR}/LICENSE")
  file(STRINGS "${PROJECT_SOURCE_DIR}/LICENSE" holder REGEX "^Copyright")
  string(REGEX REPLACE "^Copyright \\(c\\) " "" holder "${holder}")
  # Not file(CONFIGURE), which would read @ in other people's words.
  set(text "Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/\nUpstream-Name: aspic\n\n")
  string(APPEND text "Files: *\nCopyright: ${holder}\nLicense: Expat\n\nLicense: Expat\n${mit}\n")
  foreach(pair IN LISTS licenses)
    string(REGEX MATCH "^([^=]+)=(.*)$" pair "${pair}")
    set(part "${CMAKE_MATCH_1}")
    aspic_control_text(words "${CMAKE_MATCH_2}")
    string(APPEND text "\nFiles: ${part}\nCopyright: as in the text below\nLicense: ${part}\nComment: It is within the binaries of this package.\n"
           "\nLicense: ${part}\n${words}\n")
  endforeach()
  file(WRITE "${folder}/copyright" "${text}")
  # SOURCE_DATE_EPOCH is the date, where it is set.
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
  file(CONFIGURE OUTPUT "${folder}/changelog.Debian"
       CONTENT "aspic (${version}) ${codename}; urgency=medium\n\n  * Packages of Aspic ${PROJECT_VERSION} for Debian ${debian}; changelog.gz tells what is new.\n\n -- ${contact}  ${date}\n")
  execute_process(COMMAND gzip -9nc "${PROJECT_SOURCE_DIR}/CHANGELOG.md" OUTPUT_FILE "${folder}/changelog.gz" COMMAND_ERROR_IS_FATAL ANY)
  execute_process(COMMAND gzip -9nc "${folder}/changelog.Debian" OUTPUT_FILE "${folder}/changelog.Debian.gz" COMMAND_ERROR_IS_FATAL ANY)
  install(FILES "${folder}/copyright" "${folder}/changelog.gz" "${folder}/changelog.Debian.gz"
          DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/${name}" COMPONENT ${component})
endfunction()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/CHANGELOG.md" "${PROJECT_SOURCE_DIR}/LICENSE")

# Images' letters and PNG or JPEG helpers are compiled in.
set(within "DejaVu=/usr/share/doc/fonts-dejavu-core/copyright" "stb=/usr/share/doc/libstb-dev/copyright"
           "Eigen=/usr/share/doc/libeigen3-dev/copyright" "tomlplusplus=/usr/share/doc/libtomlplusplus-dev/copyright")

set(about "Aspic simulates jelly cubes, cloth, nets and balls as point masses and damped\nsprings, on a GPU (OpenGL 4.3 compute) or a CPU, with the same bits.")

aspic_package(programs aspic SECTION science RECOMMENDS "${device}, libgl1, ffmpeg" LICENCES ${within}
              "CLI11=/usr/share/doc/libcli11-dev/copyright" "nlohmann-json=/usr/share/doc/nlohmann-json3-dev/copyright"
  DESCRIPTION "soft bodies of point masses and springs\n${about}\n.\nThe program aspic runs scenes headless, records videos, compares its backends and\nmeasures itself. aspic-view shows them in a window.")

file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/debian/shlibs"
     CONTENT "libaspic ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR} ${soname_package} (>= ${version})\n")
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/debian/triggers" CONTENT "activate-noawait ldconfig\n")
aspic_package(runtime ${soname_package} SECTION libs RECOMMENDS "${device}" LICENCES ${within}
  CONTROL "${PROJECT_BINARY_DIR}/debian/shlibs" "${PROJECT_BINARY_DIR}/debian/triggers"
  DESCRIPTION "soft bodies of point masses and springs - shared library\n${about}\n.\nThis package has the library that programs are linked with.")

aspic_package(library libaspic-dev SECTION libdevel LICENCES ${within}
  DEPENDS "${soname_package} (= ${version}), libfmt-dev, libhwy-dev, libspng-dev, libstb-dev, libtomlplusplus-dev, libturbojpeg0-dev, zlib1g-dev, pkgconf"
  DESCRIPTION "soft bodies of point masses and springs - development files\n${about}\n.\nThis package has the headers, the static library, and what CMake's\nfind_package(aspic) and pkg-config read.")

# The module is for one version of Python: without nanobind's split mode it uses more than the stable ABI of 3.10.
find_package(Python 3.10 REQUIRED COMPONENTS Interpreter)
set(python "${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}")
math(EXPR python_next "${Python_VERSION_MINOR} + 1")
set(scripts "")
foreach(script IN ITEMS postinst prerm)
  configure_file("${PROJECT_SOURCE_DIR}/cmake/debian/python3-aspic.${script}" "${PROJECT_BINARY_DIR}/debian/${script}" COPYONLY)
  list(APPEND scripts "${PROJECT_BINARY_DIR}/debian/${script}")
endforeach()
file(GLOB nanobind_license "${PROJECT_SOURCE_DIR}/build/python/lib/python3*/site-packages/nanobind-*.dist-info/licenses/LICENSE")
aspic_package(python python3-aspic SECTION python LICENCES "nanobind=${nanobind_license}" CONTROL ${scripts}
  DEPENDS "${soname_package} (= ${version}), python3 (>= ${python}), python3 (<< 3.${python_next}), python3-numpy"
  RECOMMENDS "${device}" SUGGESTS "aspic (= ${version}), ffmpeg, python3-xarray"
  DESCRIPTION "soft bodies of point masses and springs - Python module\n${about}\n.\nThis package has the module aspic: scenes, simulations, batches, arrays of\nnumpy and images for notebooks.")
file(CONFIGURE OUTPUT "${PROJECT_BINARY_DIR}/debian/METADATA"
     CONTENT "Metadata-Version: 2.1\nName: aspic-softbody\nVersion: ${PROJECT_VERSION}\nSummary: ${PROJECT_DESCRIPTION}\nRequires-Python: ==${python}.*\nRequires-Dist: numpy\n")
install(FILES "${PROJECT_BINARY_DIR}/debian/METADATA" DESTINATION "lib/python3/dist-packages/aspic_softbody-${PROJECT_VERSION}.dist-info" COMPONENT python)

include(CPack)
