# One object file of several sources and libraries, in which everything but a few functions is hidden: so a program can
# hold two things that define the same names, as two ports of the HAL do.
#
#   agv_add_isolated_object(NAME node OUTPUT variable SOURCES a.c b.c ... OBJECTS_OF library ...
#     INCLUDES dir ... DEFINITIONS name=value ... EXPORTS function ...)
#
# Compiles the sources, links them and the objects of the libraries into one relocatable object, hides what is not
# listed in EXPORTS, and stores the object's path in the variable, to be named among the sources of a target. What it
# needs and does not contain is looked for in the program, as for every object.
# Without LTO, which works on names before they are hidden; without coverage, which is counted once for each source.
if(NOT CMAKE_OBJCOPY)
  message(FATAL_ERROR "objcopy is missing (binutils)")
endif()

function(agv_add_isolated_object)
  cmake_parse_arguments(PARSE_ARGV 0 OBJECT "" "NAME;OUTPUT" "SOURCES;OBJECTS_OF;INCLUDES;DEFINITIONS;EXPORTS")
  if(NOT OBJECT_NAME OR NOT OBJECT_OUTPUT OR NOT OBJECT_SOURCES OR NOT OBJECT_EXPORTS OR OBJECT_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "usage: agv_add_isolated_object(NAME name OUTPUT variable SOURCES ... EXPORTS ...)")
  endif()
  set(parts ${OBJECT_NAME}_parts)
  add_library(${parts} OBJECT ${OBJECT_SOURCES})
  target_include_directories(${parts} PRIVATE ${OBJECT_INCLUDES})
  target_compile_definitions(${parts} PRIVATE ${OBJECT_DEFINITIONS})
  target_link_libraries(${parts} PRIVATE agv_options)
  target_compile_options(${parts} PRIVATE -fno-lto)
  if(AGV_INSTRUMENT STREQUAL "coverage")
    target_compile_options(${parts} PRIVATE -fno-profile-arcs -fno-test-coverage)
  endif()

  set(objects $<TARGET_OBJECTS:${parts}>)
  foreach(library IN LISTS OBJECT_OBJECTS_OF)
    list(APPEND objects $<TARGET_OBJECTS:${library}>)
  endforeach()
  set(path ${CMAKE_CURRENT_BINARY_DIR}/${OBJECT_NAME}.o)
  list(TRANSFORM OBJECT_EXPORTS PREPEND --keep-global-symbol= OUTPUT_VARIABLE keep)
  add_custom_command(
    OUTPUT ${path}
    COMMAND ${CMAKE_C_COMPILER} -r -nostdlib -fno-lto -o ${path}.all ${objects}
    COMMAND ${CMAKE_OBJCOPY} ${keep} ${path}.all ${path}
    DEPENDS ${objects}
    COMMENT "Linking ${OBJECT_NAME} into one object"
    COMMAND_EXPAND_LISTS
    VERBATIM
  )
  set(${OBJECT_OUTPUT} ${path} PARENT_SCOPE)
endfunction()
