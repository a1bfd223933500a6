# Every target of the project is made by one of these functions, so that the language rules are in one place.

configure_file("${PROJECT_SOURCE_DIR}/cmake/version.h.in" "${PROJECT_BINARY_DIR}/include/aspic/version.h" @ONLY)
add_library(aspic_rules INTERFACE)
# Whether a target is one of aspic_computes().
set(computes "$<BOOL:$<TARGET_PROPERTY:ASPIC_COMPUTES>>")
target_include_directories(aspic_rules INTERFACE "${PROJECT_SOURCE_DIR}/include" "${PROJECT_BINARY_DIR}/include" "${PROJECT_SOURCE_DIR}/src")
# Contraction to fused multiply-add would change bits: see docs/determinism.md.
target_compile_options(aspic_rules INTERFACE -ffp-contract=off)
target_compile_features(aspic_rules INTERFACE cxx_std_20)
# Warnings are the project's own business: not that of a project which builds it along with itself.
set(own "$<AND:$<COMPILE_LANGUAGE:CXX>,$<PATH:IS_PREFIX,${PROJECT_SOURCE_DIR},$<TARGET_PROPERTY:SOURCE_DIR>>>")
target_compile_options(aspic_rules INTERFACE "$<${own}:-Wall;-Wextra;-Wconversion;-Wnon-virtual-dtor>")
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND ASPIC_ASSERTIONS)
  # GCC 12 at -O3 takes fmt's own assertions for a way past the end of its fill characters.
  target_compile_options(aspic_rules INTERFACE $<${computes}:-Wno-stringop-overflow>)
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Left alone GCC looks for garbage of its own from 256 MB on, up to a tenth of its time. No file takes more than 1.3 GB.
  target_compile_options(aspic_rules INTERFACE $<$<COMPILE_LANGUAGE:CXX>:--param=ggc-min-heapsize=400000>)
endif()
if(NOT CMAKE_UNITY_BUILD)
  # Files that are compiled together see one another's names.
  target_compile_options(aspic_rules INTERFACE $<${own}:-Wshadow>)
endif()
if(ASPIC_WARNINGS_AS_ERRORS)
  target_compile_options(aspic_rules INTERFACE $<${own}:-Werror>)
endif()
# The standard library's bounds are checked along with assertions, except where the program computes.
target_compile_definitions(aspic_rules INTERFACE
                           "$<$<AND:$<BOOL:${ASPIC_ASSERTIONS}>,$<NOT:${computes}>>:_GLIBCXX_ASSERTIONS>" $<${computes}:EIGEN_NO_DEBUG>)
if(ASPIC_FUZZ)
  # Coverage guides the fuzzer; every finding ends the program.
  set(fuzzed -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer -g1)
  target_compile_options(aspic_rules INTERFACE "$<$<NOT:$<BOOL:$<TARGET_PROPERTY:ASPIC_READS_NOTHING>>>:${fuzzed}>"
                         -w)  # warnings are the ordinary build's business
  target_link_options(aspic_rules INTERFACE -fsanitize=address,undefined)
endif()
if(ASPIC_SANITIZE)
  target_compile_options(aspic_rules INTERFACE -fsanitize=${ASPIC_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  target_link_options(aspic_rules INTERFACE -fsanitize=${ASPIC_SANITIZE})
  if(ASPIC_SANITIZE_WITHOUT)
    # Checks of every pointer that is followed cost Eigen's expressions a factor of nine; the address sanitizer sees what a wrong one reaches.
    target_compile_options(aspic_rules INTERFACE -fno-sanitize=${ASPIC_SANITIZE_WITHOUT})
  endif()
endif()

# aspic_level(TARGET LEVEL): how far a Release build optimizes a target that does not compute.
function(aspic_level target level)
  if(ASPIC_LEVELS)
    target_compile_options(${target} PRIVATE "$<$<AND:$<CONFIG:Release>,$<NOT:$<BOOL:$<TARGET_PROPERTY:ASPIC_COMPUTES>>>>:${level}>")
  endif()
endfunction()

# aspic_hidden(TARGET): the same objects make the static and the shared library, which shows nothing but what is ASPIC_API.
function(aspic_hidden target)
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ON C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
                                             VISIBILITY_INLINES_HIDDEN ON)
endfunction()

# aspic_headers(NAME LEVEL FLAGS flag … TARGETS library … HEADERS <header> …): headers of other libraries, compiled once for all targets
# of one level and these flags, which use them by aspic_precompiled(TARGET NAME). No file relies on them: `scripts/check.sh clang` compiles each by itself, without them.
function(aspic_headers name level)
  cmake_parse_arguments(arg "" "" "FLAGS;TARGETS;HEADERS" ${ARGN})
  set(source "${PROJECT_BINARY_DIR}/${name}.cpp")
  file(CONFIGURE OUTPUT "${source}" CONTENT "// Compiled for its precompiled headers.\n")
  add_library(${name} OBJECT "${source}")
  target_link_libraries(${name} PRIVATE aspic_rules ${arg_TARGETS})
  aspic_level(${name} ${level})
  target_compile_options(${name} PRIVATE ${arg_FLAGS})
  target_precompile_headers(${name} PRIVATE ${arg_HEADERS})
  set_target_properties(${name} PROPERTIES ASPIC_LEVEL ${level} ASPIC_FLAGS "${arg_FLAGS}" UNITY_BUILD OFF)
endfunction()

function(aspic_precompiled target headers)
  get_target_property(level ${headers} ASPIC_LEVEL)
  get_target_property(flags ${headers} ASPIC_FLAGS)
  aspic_level(${target} ${level})
  target_compile_options(${target} PRIVATE ${flags})
  if(ASPIC_PRECOMPILE)
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# aspic_library(NAME SOURCES a.cpp … DEPENDS target …): one room of the library. Rooms name the rooms they use; their objects
# are linked together into aspic::aspic by aspic_link_library(). Without SOURCES the room is every source file of its
# folder: where a file is a kind of something, adding the file adds the kind.
function(aspic_library name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  if(NOT arg_SOURCES)
    file(GLOB arg_SOURCES CONFIGURE_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/*.cpp")
    list(SORT arg_SOURCES)
  endif()
  add_library(${name} OBJECT ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC aspic_rules ${arg_DEPENDS})
  aspic_hidden(${name})
  aspic_precompiled(${name} aspic_room_headers)
  set_target_properties(${name} PROPERTIES UNITY_BUILD_BATCH_SIZE 32)  # a module is one unit: its headers are read once
  set_property(GLOBAL APPEND PROPERTY ASPIC_ROOMS ${name})
endfunction()

# aspic_link_library(library …): libaspic, made of all rooms and of what they are linked with: the archive, which is aspic::aspic in this
# tree, and the shared library. Who links either gets the public headers and C++20. Our own programs and tests link aspic_internals,
# the archive with the headers of all rooms.
function(aspic_link_library)
  get_property(rooms GLOBAL PROPERTY ASPIC_ROOMS)
  set(objects "$<TARGET_OBJECTS:aspic_glad>")
  foreach(room IN LISTS rooms)
    list(APPEND objects "$<TARGET_OBJECTS:${room}>")
  endforeach()
  set(made aspic_lib)
  add_library(aspic_lib STATIC ${objects})
  set_target_properties(aspic_lib PROPERTIES ARCHIVE_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}" EXPORT_NAME static)
  if(ASPIC_SHARED)
    list(APPEND made aspic_shared)
    add_library(aspic_shared SHARED ${objects})
    set(map "${PROJECT_SOURCE_DIR}/cmake/aspic.map")
    target_link_options(aspic_shared PRIVATE "LINKER:--version-script=${map},-Bsymbolic-functions,--no-undefined")
    set_target_properties(aspic_shared PROPERTIES LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}" EXPORT_NAME shared LINK_DEPENDS "${map}"
                                                  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  endif()
  foreach(library IN LISTS made)
    set_target_properties(${library} PROPERTIES OUTPUT_NAME aspic LINKER_LANGUAGE CXX)
    target_compile_features(${library} PUBLIC cxx_std_20)
    target_include_directories(${library} INTERFACE "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>" "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>"
                                                    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
    target_link_libraries(${library} PRIVATE ${ARGN})
  endforeach()
  if(ASPIC_FUZZ)
    target_link_options(aspic_lib INTERFACE -fsanitize=address,undefined)
  elseif(ASPIC_SANITIZE)
    target_link_options(aspic_lib INTERFACE -fsanitize=${ASPIC_SANITIZE})
  endif()
  add_library(aspic::aspic ALIAS aspic_lib)
  add_library(aspic_internals INTERFACE)
  target_link_libraries(aspic_internals INTERFACE aspic_lib ${rooms})
endfunction()

# aspic_program_part(NAME SOURCES a.cpp … DEPENDS target …): what a program is made of besides the library.
function(aspic_program_part name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  add_library(${name} STATIC ${arg_SOURCES})
  target_link_libraries(${name} PUBLIC aspic_rules ${arg_DEPENDS} aspic_internals)
  aspic_hidden(${name})  # as the headers that it shares with the rooms
  aspic_precompiled(${name} aspic_room_headers)
endfunction()

# aspic_runs(TARGET program …): tests that run other programs, which are built with them; aspic with aspic-studies. ASPIC_OBJECTS_ONLY leaves them out, since
# compiling one file of the target would wait for them.
function(aspic_runs target)
  if(NOT ASPIC_OBJECTS_ONLY)
    add_dependencies(${target} ${ARGN})
    if("aspic" IN_LIST ARGN)
      add_dependencies(${target} aspic-studies)
    endif()
  endif()
endfunction()

# aspic_computes(NAME [LEVEL]): a module that computes at length, optimized as far as the compiler can or in a Release build to this level,
# without checks inside its loops.
# Below -O2 clang inlines nothing of Eigen and Highway: minutes become hours under the sanitizers.
function(aspic_computes name)
  set_target_properties(${name} PROPERTIES ASPIC_COMPUTES ON)
  if(ASPIC_PRECOMPILE AND NOT name STREQUAL "aspic_compute_headers")
    set_target_properties(${name} PROPERTIES PRECOMPILE_HEADERS_REUSE_FROM aspic_compute_headers)
  endif()
  if(ASPIC_LEVELS AND ARGN)
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:${ARGN}>)
  endif()
  if(ASPIC_SANITIZE)
    target_compile_options(${name} PRIVATE -O2)
  endif()
endfunction()

# aspic_test_program(NAME SOURCES a_test.cpp … DEPENDS target …): a program of tests, which ctest does not know yet. Rooms among the targets
# say what is tested; they come from the library.
function(aspic_test_program name)
  cmake_parse_arguments(arg "" "" "SOURCES;DEPENDS" ${ARGN})
  get_property(rooms GLOBAL PROPERTY ASPIC_ROOMS)
  list(REMOVE_ITEM arg_DEPENDS ${rooms})
  add_executable(${name} ${arg_SOURCES})
  target_link_libraries(${name} PRIVATE aspic_rules ${arg_DEPENDS} aspic_internals GTest::gtest GTest::gmock aspic_test_main)
  target_include_directories(${name} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  aspic_precompiled(${name} aspic_test_headers)
endfunction()

# aspic_busy(NAME): tests that are at work for longer than they take to compile.
function(aspic_busy name)
  aspic_level(${name} -O1)
  set_target_properties(${name} PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)  # which are for another level
endfunction()

# aspic_gl_tests(NAME FILTER): tests of any device, which the GPU kit takes along (scripts/gpu_kit.sh). Their list is
# gl_tests.txt in the build directory, and the target gl_tests builds them.
function(aspic_gl_tests name filter)
  file(RELATIVE_PATH path "${PROJECT_BINARY_DIR}" "${CMAKE_CURRENT_BINARY_DIR}/${name}")
  set_property(GLOBAL APPEND PROPERTY ASPIC_GL_TESTS "${path} ${filter}")
  set_property(GLOBAL APPEND PROPERTY ASPIC_GL_PROGRAMS ${name})
endfunction()

# aspic_test(NAME SOURCES a_test.cpp … DEPENDS target …): one test binary, each suite of it a test of ctest's (cmake/AspicSuites.cmake):
# a process for each case would make a context and compile the shaders each time. EACH_CASE: a process for each case all the
# same, for cases that take long or want a process of their own. Patterns are those of --gtest_filter: SOFTWARE pattern gives the
# label software to tests that mean software rasterizers alone, FULL part=pattern … moves
# tests to those parts of the full tier.
function(aspic_test name)
  cmake_parse_arguments(arg "EACH_CASE" "SOFTWARE" "SOURCES;DEPENDS;FULL" ${ARGN})
  aspic_test_program(${name} SOURCES ${arg_SOURCES} DEPENDS ${arg_DEPENDS})
  if("threads" IN_LIST ASPIC_TEST_PROPERTIES)
    set_property(GLOBAL APPEND PROPERTY ASPIC_THREADED_TESTS ${name})
  endif()
  set(timeout 600)
  if(ASPIC_SANITIZE)
    set(timeout 1800)
  endif()
  set(properties TIMEOUT ${timeout} ${ASPIC_TEST_PROPERTIES})
  if(arg_EACH_CASE)
    gtest_discover_tests(${name} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
    return()
  endif()
  set(labels "")
  if(arg_SOFTWARE)
    list(APPEND labels "software=${arg_SOFTWARE}")
  endif()
  set(all "")
  if(arg_FULL)
    list(TRANSFORM arg_FULL REPLACE "^[^=]+=" "" OUTPUT_VARIABLE all)
    list(JOIN all ":" all)
    list(APPEND labels "full=${all}" ${arg_FULL})
  endif()
  if("aspic_gl_testing" IN_LIST arg_DEPENDS)
    string(REGEX REPLACE "^:|:$" "" left_out "${arg_SOFTWARE}:${all}")
    aspic_gl_tests(${name} "*-${left_out}")
  endif()
  set(base "${CMAKE_CURRENT_BINARY_DIR}/${name}_suites")
  list(JOIN properties " " properties)
  file(GENERATE OUTPUT "${base}.cmake"
       CONTENT "set(settings [[${base}.cmake]])
set(list [[${base}_list.cmake]])
set(binary [[$<TARGET_FILE:${name}>]])
set(labels [[${labels}]])
set(properties [[${properties}]])
include([[${PROJECT_SOURCE_DIR}/cmake/AspicSuites.cmake]])
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${base}.cmake")
endfunction()
