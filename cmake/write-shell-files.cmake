# Writes what host_sim prints about its own command line: man pages and completion for three shells.
#
#   cmake -DPROGRAM=<host_sim> -DTO=<folder> -DZSH=<folder in it> -P write-shell-files.cmake
find_program(gzip gzip)

# write(FILE ARGUMENT...): what host_sim prints with these arguments
function(write FILE)
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_VARIABLE text COMMAND_ERROR_IS_FATAL ANY)
  file(WRITE ${TO}/${FILE} "${text}")
endfunction()

file(REMOVE_RECURSE ${TO})
write(bash-completion/completions/host_sim completion bash)
write(${ZSH}/_host_sim completion zsh)
write(fish/vendor_completions.d/host_sim.fish completion fish)
write(man/man1/host_sim.1 man)
file(STRINGS ${TO}/man/man1/host_sim.1 lines REGEX "^\\.BR host_sim\\\\-[a-z]+ \\(1\\)$")
foreach(line IN LISTS lines)
  string(REGEX REPLACE ".*\\\\-([a-z]+) .*" "\\1" command "${line}")
  write(man/man1/host_sim-${command}.1 man ${command})
endforeach()
if(gzip)
  file(GLOB pages ${TO}/man/man1/*.1)
  execute_process(COMMAND ${gzip} -9nf ${pages} COMMAND_ERROR_IS_FATAL ANY)
endif()
