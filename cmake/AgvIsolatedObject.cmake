# One object file of several sources and libraries, in which everything but a few functions is hidden: so a program can
# hold two things that define the same names, as two ports of the HAL do.
#
#   agv_add_isolated_object(NAME node OUTPUT variable EXPORTS function ...
#     SOURCES a.c ... [COPIES b.c ...] [OBJECTS_OF library ...] [INCLUDES dir ...] [DEFINITIONS name=value ...])
#
# Compiles the sources, links them and the objects of the libraries into one relocatable object, hides what is not
# listed in EXPORTS, and stores the object's path in the variable, to be named among the sources of a target. What it
# needs and does not contain is looked for in the program, as for every object.
# COPIES are sources that other targets compile as well: neither coverage nor clang-tidy looks at them a second time.
# All of it is compiled without LTO, which works on names before they are hidden.
if(NOT CMAKE_OBJCOPY)
  message(FATAL_ERROR "objcopy is missing (binutils)")
endif()

# The object library of some of its sources.
function(agv_isolated_part NAME)
  cmake_parse_arguments(PARSE_ARGV 1 PART "" "" "SOURCES;INCLUDES;DEFINITIONS")
  add_library(${NAME} OBJECT ${PART_SOURCES})
  target_include_directories(${NAME} PRIVATE ${PART_INCLUDES})
  target_compile_definitions(${NAME} PRIVATE ${PART_DEFINITIONS})
  target_compile_options(${NAME} PRIVATE -fno-lto)
  target_link_libraries(${NAME} PRIVATE agv_options)
endfunction()

function(agv_add_isolated_object)
  cmake_parse_arguments(PARSE_ARGV 0 OBJECT "" "NAME;OUTPUT" "EXPORTS;SOURCES;COPIES;OBJECTS_OF;INCLUDES;DEFINITIONS")
  if(NOT OBJECT_NAME OR NOT OBJECT_OUTPUT OR NOT OBJECT_EXPORTS OR NOT OBJECT_SOURCES OR OBJECT_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "usage: agv_add_isolated_object(NAME name OUTPUT variable EXPORTS ... SOURCES ...)")
  endif()
  agv_isolated_part(${OBJECT_NAME}_parts SOURCES ${OBJECT_SOURCES}
    INCLUDES ${OBJECT_INCLUDES} DEFINITIONS ${OBJECT_DEFINITIONS})
  set(objects $<TARGET_OBJECTS:${OBJECT_NAME}_parts>)
  if(OBJECT_COPIES)
    set(copies ${OBJECT_NAME}_copies)
    agv_isolated_part(${copies} SOURCES ${OBJECT_COPIES} INCLUDES ${OBJECT_INCLUDES} DEFINITIONS ${OBJECT_DEFINITIONS})
    get_target_property(options ${copies} COMPILE_OPTIONS)
    list(REMOVE_ITEM options --coverage)
    set_target_properties(${copies} PROPERTIES COMPILE_OPTIONS "${options}" EXPORT_COMPILE_COMMANDS OFF)
    list(APPEND objects $<TARGET_OBJECTS:${copies}>)
  endif()
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
