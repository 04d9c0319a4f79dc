# Seeded faults of seeded.tsv as programs, built with everything else: a copy of the product's source with the line's
# change is linked instead of the one in the library.
#
#   agv_add_seeded(CHECKER SOURCES a.c ... [LIBS library ...] [OPTIONS link-option ...] [ONLY word])
#   agv_add_seeded(CHECKER COMPILE_ONLY)
#
# One program seeded_CHECKER_NAME for each fault of the checker; ONLY: those that are run with this word. seed.py runs
# them. COMPILE_ONLY: the changed sources are compiled; another tool reads them. Built in an ordinary build, and in that
# of the fuzz targets (target fuzz_seeded).
set(AGV_SEED_FOLDER ${CMAKE_CURRENT_LIST_DIR})
set_property(DIRECTORY ${PROJECT_SOURCE_DIR} APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${AGV_SEED_FOLDER}/seeded.tsv)
add_custom_target(fuzz_seeded)

# Without Python the programs still build. The tests of the seeded faults then fail.
find_program(AGV_SEED_PYTHON python3)
if(NOT AGV_SEED_PYTHON)
  message(STATUS "The seeded faults are left out: there is no python3")
endif()

function(agv_add_seeded CHECKER)
  cmake_parse_arguments(PARSE_ARGV 1 arg "COMPILE_ONLY" "ONLY" "SOURCES;LIBS;OPTIONS")
  if(NOT AGV_SEED_PYTHON OR (AGV_INSTRUMENT AND NOT AGV_INSTRUMENT STREQUAL "fuzz"))
    return()
  endif()
  execute_process(COMMAND ${AGV_SEED_FOLDER}/seed.py list ${CHECKER}
    OUTPUT_VARIABLE faults OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE status)
  if(status)
    message(FATAL_ERROR "the seeded faults of ${CHECKER} cannot be read")
  endif()
  string(REPLACE ";" "," faults "${faults}")
  string(REPLACE "\n" ";" faults "${faults}")
  foreach(fault IN LISTS faults)
    string(REPLACE "|" ";" columns "${fault}")
    list(POP_FRONT columns name with)
    if(NOT arg_ONLY OR arg_ONLY STREQUAL with)
      agv_add_seeded_program(${CHECKER} ${name} ${columns})
    endif()
  endforeach()
endfunction()

# agv_add_seeded_program(CHECKER NAME file...): with the arguments of agv_add_seeded
macro(agv_add_seeded_program CHECKER NAME)
  set(program seeded_${CHECKER}_${NAME})
  set(folder ${PROJECT_BINARY_DIR}/seeded/${CHECKER}/${NAME})
  set(copies)
  set(originals)
  foreach(file ${ARGN})
    get_filename_component(base ${file} NAME)
    list(APPEND copies ${folder}/${base})
    list(APPEND originals ${PROJECT_SOURCE_DIR}/${file})
  endforeach()
  add_custom_command(OUTPUT ${copies}
    COMMAND ${AGV_SEED_FOLDER}/seed.py apply ${CHECKER}/${NAME} ${folder}
    DEPENDS ${originals} ${AGV_SEED_FOLDER}/seed.py ${AGV_SEED_FOLDER}/seeded.tsv
    COMMENT "Seeding ${CHECKER}/${NAME}" VERBATIM)
  set_source_files_properties(${copies} PROPERTIES COMPILE_OPTIONS -w)
  if(arg_COMPILE_ONLY)
    add_library(${program} OBJECT ${copies})
  else()
    add_executable(${program} ${arg_SOURCES} ${copies})
    target_link_options(${program} PRIVATE $<$<NOT:$<BOOL:${AGV_INSTRUMENT}>>:-fno-lto> ${arg_OPTIONS})
  endif()
  target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR}/firmware/src)
  target_link_libraries(${program} PRIVATE agv_options agv_core ${arg_LIBS})
  if(AGV_INSTRUMENT)
    set_target_properties(${program} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_dependencies(fuzz_seeded ${program})
  endif()
endmacro()
