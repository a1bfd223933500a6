# Manual pages by help2man, and completion of shells: part of an installation, not of the programs.
find_program(ASPIC_HELP2MAN help2man)
if(NOT ASPIC_HELP2MAN)
  if(ASPIC_PACKAGES)
    message(FATAL_ERROR "Packages need help2man, Debian package help2man.")
  endif()
  message(STATUS "There will be no manual pages: help2man was not found (Debian package help2man).")
  return()
endif()

set(manual "${PROJECT_BINARY_DIR}/manual")
set(page "${PROJECT_SOURCE_DIR}/docs/commands.md")
set(script "${PROJECT_SOURCE_DIR}/scripts/manual_pages.sh")
set(compress "")
if(ASPIC_PACKAGES)
  set(compress COMMAND sh -c "gzip -9n \"$1\"/*.1" sh "${manual}")
endif()
add_custom_command(OUTPUT "${manual}.stamp"
                   COMMAND "${script}" "$<TARGET_FILE:aspic>" "${page}" "${manual}" ${compress}
                   COMMAND ${CMAKE_COMMAND} -E touch "${manual}.stamp"
                   DEPENDS aspic "${page}" "${script}" COMMENT "Manual pages" VERBATIM)
add_custom_target(manual ALL DEPENDS "${manual}.stamp")

if(ASPIC_INSTALL)
  # Debian's zsh reads packages' completion in a directory with another name.
  set(zsh site-functions)
  if(ASPIC_PACKAGES)
    set(zsh vendor-completions)
  endif()
  set(shell "${PROJECT_SOURCE_DIR}/assets/shell")
  set(bash "${CMAKE_INSTALL_DATADIR}/bash-completion/completions")
  set(fish "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d")
  install(DIRECTORY "${manual}/" DESTINATION "${CMAKE_INSTALL_MANDIR}/man1" COMPONENT programs)
  install(FILES "${shell}/_aspic" DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/${zsh}" COMPONENT programs)
  foreach(program aspic aspic-view)
    install(FILES "${shell}/aspic.bash" DESTINATION "${bash}" RENAME ${program} COMPONENT programs)
    install(FILES "${shell}/aspic.fish" DESTINATION "${fish}" RENAME ${program}.fish COMPONENT programs)
  endforeach()
  # The documents that the pages name.
  install(DIRECTORY "${PROJECT_SOURCE_DIR}/docs/" DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT programs FILES_MATCHING PATTERN "*.md"
          PATTERN images EXCLUDE)
endif()
