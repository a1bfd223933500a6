# aspic_embed_shaders(TARGET ROOT directory SYMBOL function)
#   adds to TARGET a generated source that defines
#     std::span<const aspic::gl::EmbeddedShader> aspic::gl::SYMBOL();
#   with every file under ROOT, named by its path relative to ROOT, in the order of the names.
# Run as a script (cmake -P) it writes that source: ROOT, OUTPUT and SYMBOL come by -D.

if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(ASPIC_EMBED_SHADERS_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

  function(aspic_embed_shaders target)
    cmake_parse_arguments(arg "" "ROOT;SYMBOL" "" ${ARGN})
    file(GLOB_RECURSE files CONFIGURE_DEPENDS "${arg_ROOT}/*.glsl" "${arg_ROOT}/*.comp" "${arg_ROOT}/*.vert"
         "${arg_ROOT}/*.frag" "${arg_ROOT}/*.geom")
    set(output "${CMAKE_CURRENT_BINARY_DIR}/${arg_SYMBOL}.cpp")
    add_custom_command(
      OUTPUT "${output}"
      COMMAND "${CMAKE_COMMAND}" "-DROOT=${arg_ROOT}" "-DOUTPUT=${output}" "-DSYMBOL=${arg_SYMBOL}" -P
              "${ASPIC_EMBED_SHADERS_SCRIPT}"
      DEPENDS ${files} "${ASPIC_EMBED_SHADERS_SCRIPT}"
      COMMENT "Embedding the shaders"
      VERBATIM)
    target_sources(${target} PRIVATE "${output}")
  endfunction()
  return()
endif()

file(GLOB_RECURSE names RELATIVE "${ROOT}" "${ROOT}/*.glsl" "${ROOT}/*.comp" "${ROOT}/*.vert" "${ROOT}/*.frag"
     "${ROOT}/*.geom")
list(SORT names)
file(WRITE "${OUTPUT}" "// Generated from the shader files by cmake/EmbedShaders.cmake.\n#include \"gpu/shader_source.h\"\n\n"
     "namespace aspic::gl {\nnamespace {\nconstexpr EmbeddedShader files[] = {\n")
foreach(name IN LISTS names)
  file(READ "${ROOT}/${name}" text)
  string(FIND "${text}" ")aspic_shader\"" clash)
  if(NOT clash EQUAL -1)
    message(FATAL_ERROR "${ROOT}/${name} contains the delimiter of the embedding, )aspic_shader\".")
  endif()
  file(APPEND "${OUTPUT}" "    {\"${name}\", R\"aspic_shader(${text})aspic_shader\"},\n")
endforeach()
file(APPEND "${OUTPUT}" "};\n}  // namespace\n\nstd::span<const EmbeddedShader> ${SYMBOL}() {\n  return files;\n}\n\n"
     "}  // namespace aspic::gl\n")
