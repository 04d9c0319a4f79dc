# Put the page together in OUT: the files of web/page, the report's modules and styles, the scenarios and their list.
# cmake -DROOT=... -DOUT=... -DWASM=agv.wasm -P page.cmake
file(REMOVE_RECURSE ${OUT})
file(COPY ${ROOT}/web/page/ DESTINATION ${OUT})
file(COPY ${ROOT}/host_sim/report/page/ DESTINATION ${OUT}/report FILES_MATCHING PATTERN "*.js" PATTERN "*.css")
file(COPY ${ROOT}/host_sim/scenarios/ DESTINATION ${OUT}/scenarios FILES_MATCHING PATTERN "*.yaml")
file(COPY ${WASM} DESTINATION ${OUT})
file(GLOB_RECURSE files RELATIVE ${ROOT}/host_sim/scenarios ${ROOT}/host_sim/scenarios/*.yaml)
list(SORT files)
set(list "")
foreach(file ${files})
  file(STRINGS ${ROOT}/host_sim/scenarios/${file} name REGEX "^name: " LIMIT_COUNT 1)
  string(REGEX REPLACE "^name: *\"?([^\"]*)\"?$" "\\1" name "${name}")
  string(REPLACE "\\;" ";" name "${name}") # a line that was read as a list
  string(APPEND list "${file}\t${name}\n")
endforeach()
file(WRITE ${OUT}/scenarios/list.txt "${list}")
