# Copies a program's profile to where gcc looks for it when it compiles the same sources in another build tree.
#
#   cmake -DFROM=<tree that counted> -DFOR=<tree to compile in> -DTO=<folder of counts> -P collect-profile.cmake
#
# gcc names the file after the object: its full path, with # for each /.
file(REMOVE_RECURSE ${TO}) # it may lie in FROM, and would be copied into itself
file(GLOB_RECURSE counts RELATIVE ${FROM} ${FROM}/*.gcda)
if(NOT counts)
  message(FATAL_ERROR "${FROM}: no profile was recorded")
endif()
file(MAKE_DIRECTORY ${TO})
foreach(count IN LISTS counts)
  string(REPLACE "/" "#" name "${FOR}/${count}")
  file(COPY_FILE ${FROM}/${count} "${TO}/${name}")
endforeach()
