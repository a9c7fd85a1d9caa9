# cmake -DNPM=npm -DFROM=analysis/report -DTO=FOLDER -P fetch.cmake
# Fetches the packages of package-lock.json into TO/node_modules. TO/fetched says "yes", or why not: a machine without a
# network builds clast without the page.
file(MAKE_DIRECTORY ${TO})
file(COPY ${FROM}/package.json ${FROM}/package-lock.json DESTINATION ${TO})
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${TO}
  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(code EQUAL 0)
  file(WRITE ${TO}/fetched "yes\n")
else()
  file(WRITE ${TO}/fetched "no\n")
  message("npm ci failed; `clast report` will not work until the next build has a network:\n${said}")
endif()
