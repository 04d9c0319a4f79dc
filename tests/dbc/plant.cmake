# Copies a file with one text replaced, to plant a failure: cmake -DIN=... -DOUT=... -DFROM=... -DTO=... -P plant.cmake
# The text must stand there exactly once: else what would be tested is not what was meant.
file(READ "${IN}" content)
string(FIND "${content}" "${FROM}" first)
string(FIND "${content}" "${FROM}" last REVERSE)
if(first EQUAL -1 OR NOT first EQUAL last)
  message(FATAL_ERROR "Cannot plant a failure in ${IN}: there is none or more than one of this text:\n${FROM}")
endif()
string(REPLACE "${FROM}" "${TO}" content "${content}")
file(WRITE "${OUT}" "${content}")
