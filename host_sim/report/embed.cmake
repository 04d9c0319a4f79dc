# Write the page as texts of C into OUT: page_frame, page_styles and page_modules.
# cmake -DOUT=page_parts.c -DFRAME=report.html -DSTYLES=a.css,b.css -DMODULES=a.js,b.js -P embed.cmake
# The page has one script, in which the modules follow each other: their import lines are left out.
function(add_text name text)
  string(HEX "${text}" bytes)
  string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  file(APPEND ${OUT} "const char ${name}[] = {\n${bytes}0};\n")
endfunction()

function(join_files result)
  set(joined "")
  foreach(file ${ARGN})
    file(READ ${file} text)
    string(REGEX REPLACE "(^|\n)import [^\n]*" "\\1" text "${text}")
    string(APPEND joined "${text}")
  endforeach()
  set(${result} "${joined}" PARENT_SCOPE)
endfunction()

string(REPLACE "," ";" STYLES "${STYLES}")
string(REPLACE "," ";" MODULES "${MODULES}")
file(WRITE ${OUT} "/* Made of host_sim/report/page by embed.cmake. */\n#include \"report/page_parts.h\"\n")
foreach(part FRAME STYLES MODULES)
  string(TOLOWER page_${part} name)
  join_files(text ${${part}})
  add_text(${name} "${text}")
endforeach()
