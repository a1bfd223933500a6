# aspic_embed_files(TARGET NAMESPACE name [BASE dir] FILES file …)
#
# Compiles text files into TARGET. Its sources then include "embedded/NAME.h" (NAME is the namespace), which declares
#   std::span<const aspic::EmbeddedFile> aspic::NAME::embedded_files();   // in the order of FILES
# The name of each file is its path relative to BASE (default: the current source directory). A changed file is embedded
# anew by the next build. Files must be text: no NUL bytes.
function(aspic_embed_files target)
  cmake_parse_arguments(arg "" "NAMESPACE;BASE" "FILES" ${ARGN})
  if(NOT arg_BASE)
    set(arg_BASE "${CMAKE_CURRENT_SOURCE_DIR}")
  endif()
  set(directory "${CMAKE_CURRENT_BINARY_DIR}/${target}_embedded")
  set(header "${directory}/embedded/${arg_NAMESPACE}.h")
  set(source "${directory}/${arg_NAMESPACE}.cpp")
  set(files "")
  foreach(file IN LISTS arg_FILES)
    get_filename_component(file "${file}" ABSOLUTE)
    list(APPEND files "${file}")
  endforeach()
  # A list does not survive the command line of every generator, so it travels in a file of its own, rewritten only when
  # it changes.
  set(list_file "${directory}/${arg_NAMESPACE}.txt")
  file(CONFIGURE OUTPUT "${list_file}" CONTENT "${files}\n" @ONLY)
  add_custom_command(
    OUTPUT "${header}" "${source}"
    COMMAND "${CMAKE_COMMAND}" -D "LIST_FILE=${list_file}" -D "BASE=${arg_BASE}" -D "NAMESPACE=${arg_NAMESPACE}"
            -D "HEADER=${header}" -D "SOURCE=${source}" -P "${PROJECT_SOURCE_DIR}/cmake/EmbedFilesScript.cmake"
    DEPENDS ${files} "${list_file}" "${PROJECT_SOURCE_DIR}/cmake/EmbedFilesScript.cmake"
    COMMENT "Embedding ${arg_NAMESPACE}"
    VERBATIM)
  target_sources(${target} PRIVATE "${header}" "${source}")
  target_include_directories(${target} PRIVATE "${directory}")
endfunction()
