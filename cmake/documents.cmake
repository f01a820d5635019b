# cmake -DPROGRAM=graftal -DFOLDER=DIR -P documents.cmake: the pages of the manual and the shells' completions, as the
# program prints them, into DIR/man1 and DIR/SHELL.
execute_process(COMMAND ${PROGRAM} version --json OUTPUT_VARIABLE known COMMAND_ERROR_IS_FATAL ANY)

function(print path)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${path} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(MAKE_DIRECTORY ${FOLDER}/man1 ${FOLDER}/bash ${FOLDER}/fish ${FOLDER}/zsh)
print(${FOLDER}/man1/graftal.1 manual)
string(JSON last LENGTH ${known} commands)
math(EXPR last "${last} - 1")
foreach(i RANGE ${last})
  string(JSON command GET ${known} commands ${i})
  string(REPLACE " " "-" page "graftal-${command}.1")
  string(REPLACE " " ";" words "${command}")
  print(${FOLDER}/man1/${page} manual ${words})
endforeach()
print(${FOLDER}/bash/graftal completion bash)
print(${FOLDER}/fish/graftal.fish completion fish)
print(${FOLDER}/zsh/_graftal completion zsh)
