# Made by the program that was built, so they say what it does. It has to run here for that.
find_program(PYTHON3 python3)
if(NOT PYTHON3 OR CMAKE_CROSSCOMPILING)
  message(STATUS "No man pages: they need python3, and a program that runs on this machine")
  return()
endif()
set(pages ${PROJECT_BINARY_DIR}/man)
add_custom_command(OUTPUT ${pages}/proofmass.1.gz
  COMMAND ${PYTHON3} ${PROJECT_SOURCE_DIR}/tools/man_pages.py $<TARGET_FILE:proofmass>
    ${PROJECT_SOURCE_DIR}/docs/cli.md ${pages}
  DEPENDS proofmass ${PROJECT_SOURCE_DIR}/tools/man_pages.py ${PROJECT_SOURCE_DIR}/docs/cli.md
  COMMENT "Making the man pages"
  VERBATIM)
add_custom_target(man_pages ALL DEPENDS ${pages}/proofmass.1.gz)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program
  FILES_MATCHING PATTERN *.1.gz)
