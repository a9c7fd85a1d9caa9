# cmake -DNODE=node -DFROM=analysis/report -DPACKAGES=FOLDER -DPAGE=report.html -P bundle.cmake
# Writes the page, unless its packages could not be fetched.
file(READ ${PACKAGES}/fetched fetched)
if(NOT fetched STREQUAL "yes\n")
  file(REMOVE ${PACKAGES}/fetched ${PAGE}) # the next build tries again
  return()
endif()
execute_process(COMMAND ${NODE} ${FROM}/bundle.mjs ${FROM} ${PACKAGES} ${PAGE} COMMAND_ERROR_IS_FATAL ANY)
