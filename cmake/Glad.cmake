# aspic_glad: the OpenGL 4.3 core loader, generated from Debian's python3-glad without the network.

# aspic_find_glad(OUT): the command that runs the generator. The first python3 on PATH may be one without glad, so
# every candidate is tried before it is believed.
function(aspic_find_glad out)
  find_program(ASPIC_GLAD_PROGRAM NAMES glad HINTS /usr/bin DOC "The glad 2 generator")
  set(candidates)
  if(ASPIC_GLAD_PROGRAM)
    list(APPEND candidates "${ASPIC_GLAD_PROGRAM}")
  endif()
  list(APPEND candidates "/usr/bin/glad" "/usr/bin/python3 -m glad" "python3 -m glad")
  foreach(candidate IN LISTS candidates)
    separate_arguments(command UNIX_COMMAND "${candidate}")
    execute_process(COMMAND ${command} --help RESULT_VARIABLE failed OUTPUT_VARIABLE text ERROR_VARIABLE text)
    if(failed EQUAL 0 AND text MATCHES "--reproducible")
      set(${out} ${command} PARENT_SCOPE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "No glad 2 generator was found, which makes the OpenGL loader. Install it with: apt install python3-glad")
endfunction()

aspic_find_glad(glad_command)
# No extensions: to look for one, glad copies the names of all and reads the copies for which there was no memory.
set(glad_directory "${CMAKE_CURRENT_BINARY_DIR}/glad")
add_custom_command(
  OUTPUT "${glad_directory}/src/gl.c" "${glad_directory}/include/glad/gl.h" "${glad_directory}/include/KHR/khrplatform.h"
  COMMAND ${glad_command} --api gl:core=4.3 --extensions "" --out-path "${glad_directory}" --reproducible --quiet c
  COMMENT "Generating the OpenGL 4.3 loader"
  VERBATIM)
# Generated C: none of the project's warning flags.
add_library(aspic_glad OBJECT "${glad_directory}/src/gl.c" "${glad_directory}/include/glad/gl.h")
target_include_directories(aspic_glad SYSTEM PUBLIC "${glad_directory}/include")
aspic_hidden(aspic_glad)
