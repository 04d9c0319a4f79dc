# Write the files of FILES as texts of C into OUT: page/report.css becomes page_report_css.
# cmake -DOUT=page_parts.c -DFILES=a.html,b.css -P embed.cmake
string(REPLACE "," ";" FILES "${FILES}")
set(text "/* Made of host_sim/report/page by embed.cmake. */\n#include \"report/page_parts.h\"\n")
foreach(file ${FILES})
  get_filename_component(name ${file} NAME)
  string(REPLACE "." "_" name ${name})
  file(READ ${file} bytes HEX)
  string(REGEX REPLACE "(................................................................)" "\\1\n" bytes "${bytes}")
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
  string(APPEND text "const char page_${name}[] = {\n${bytes}0};\n")
endforeach()
file(WRITE ${OUT} "${text}")
