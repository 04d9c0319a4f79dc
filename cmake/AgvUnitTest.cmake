# Unit tests with Unity and CMock.
#
#   agv_add_unit_test(NAME test_gate SOURCES test_gate.c [more.c ...] [MOCKS hal/can.h ...] [LIBS hal_sim ...] [PLANTED]
#     [NO_TEST])
#
# Builds one program from the sources, a runner generated from the first of them, and the generated mocks, and adds it
# to ctest. A test includes a mock as "mock_can.h" (for hal/can.h). Every program is linked to agv_core.
# Mocks stand in for the HAL contract, hal/include, and for nothing else: the rest of the core is tested as it is.
# NO_TEST: the program is built, and run by a test of somebody else.
# PLANTED: a test that has to fail; it is built by its name only and run by `ctest -C planted` only (tests/gates).

find_program(AGV_RUBY ruby)
set(AGV_GEMS ${PROJECT_SOURCE_DIR}/build/gems)
set(AGV_UNITY ${AGV_GEMS}/vendor/unity)
set(AGV_CMOCK ${AGV_GEMS}/vendor/cmock)
set(AGV_CMOCK_CONFIG ${PROJECT_SOURCE_DIR}/tests/cmock.yml)
set(AGV_TEST_TIMEOUT 120 CACHE STRING "Seconds after which a test program is stuck")
set(AGV_MOCK_DIR ${PROJECT_BINARY_DIR}/mocks)

# Without Ruby the programs still build (target host_sim and others): only the tests ask for it, when they are built.
if(NOT AGV_RUBY)
  set(AGV_RUBY ruby)
endif()

# The gems are shared by all build trees, what is compiled of them is copied: so `clean` leaves the gems alone.
set(AGV_GEMS_STAMP ${PROJECT_BINARY_DIR}/gems.stamp)
add_custom_command(
  OUTPUT ${AGV_GEMS_STAMP}
  COMMAND ${PROJECT_SOURCE_DIR}/scripts/bundle-gems
  COMMAND ${CMAKE_COMMAND} -E touch ${AGV_GEMS_STAMP}
  DEPENDS ${PROJECT_SOURCE_DIR}/Gemfile.lock ${PROJECT_SOURCE_DIR}/scripts/bundle-gems
  COMMENT "Installing Unity and CMock into build/gems"
)
set(AGV_UNITY_COPY ${PROJECT_BINARY_DIR}/unity)
set(unity_files
  ${AGV_UNITY}/src/unity.c ${AGV_UNITY}/src/unity.h ${AGV_UNITY}/src/unity_internals.h
  ${AGV_CMOCK}/src/cmock.c ${AGV_CMOCK}/src/cmock.h ${AGV_CMOCK}/src/cmock_internals.h)
add_custom_command(
  OUTPUT ${AGV_UNITY_COPY}/unity.c ${AGV_UNITY_COPY}/unity.h ${AGV_UNITY_COPY}/unity_internals.h
    ${AGV_UNITY_COPY}/cmock.c ${AGV_UNITY_COPY}/cmock.h ${AGV_UNITY_COPY}/cmock_internals.h
  COMMAND ${CMAKE_COMMAND} -E make_directory ${AGV_UNITY_COPY}
  COMMAND ${CMAKE_COMMAND} -E copy ${unity_files} ${AGV_UNITY_COPY}
  DEPENDS ${AGV_GEMS_STAMP}
)
add_library(unity STATIC ${AGV_UNITY_COPY}/unity.c ${AGV_UNITY_COPY}/cmock.c)
target_include_directories(unity SYSTEM PUBLIC ${AGV_UNITY_COPY})
if(AGV_INSTRUMENT STREQUAL "mutation")
  target_sources(unity PRIVATE ${PROJECT_SOURCE_DIR}/tests/mutation/stop_at_failure.c)
  target_compile_definitions(unity PRIVATE "UNITY_OUTPUT_FLUSH=agv_stop_at_failure"
    "UNITY_OUTPUT_FLUSH_HEADER_DECLARATION=agv_stop_at_failure(void)")
endif()

# The library target of the mock of one header of the HAL contract, made when it is first asked for.
function(agv_mock_of HEADER TARGET_VARIABLE)
  if(NOT HEADER MATCHES "^hal/([a-z_]+)\\.h$" OR NOT EXISTS ${PROJECT_SOURCE_DIR}/hal/include/${HEADER})
    message(FATAL_ERROR "'${HEADER}' cannot be mocked: mocks replace headers of hal/include and nothing else")
  endif()
  set(mock mock_${CMAKE_MATCH_1})
  set(${TARGET_VARIABLE} ${mock} PARENT_SCOPE)
  if(TARGET ${mock})
    return()
  endif()
  set(header_path ${PROJECT_SOURCE_DIR}/hal/include/${HEADER})
  add_custom_command(
    OUTPUT ${AGV_MOCK_DIR}/${mock}.c ${AGV_MOCK_DIR}/${mock}.h
    COMMAND ${AGV_RUBY} --disable-gems ${AGV_CMOCK}/lib/cmock.rb -o${AGV_CMOCK_CONFIG} --mock_path=${AGV_MOCK_DIR} ${header_path}
    DEPENDS ${header_path} ${AGV_CMOCK_CONFIG} ${AGV_GEMS_STAMP}
    COMMENT "Mocking ${HEADER}"
    VERBATIM
  )
  add_library(${mock} STATIC ${AGV_MOCK_DIR}/${mock}.c ${AGV_MOCK_DIR}/${mock}.h)
  target_include_directories(${mock} SYSTEM PUBLIC ${AGV_MOCK_DIR} ${PROJECT_SOURCE_DIR}/hal/include)
  target_link_libraries(${mock} PUBLIC unity)
endfunction()

function(agv_add_unit_test)
  cmake_parse_arguments(PARSE_ARGV 0 TEST "PLANTED;NO_TEST" "NAME" "SOURCES;MOCKS;LIBS")
  if(NOT TEST_NAME OR NOT TEST_SOURCES OR TEST_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "usage: agv_add_unit_test(NAME name SOURCES file.c ... [MOCKS hal/x.h ...] [LIBS lib ...])")
  endif()
  list(GET TEST_SOURCES 0 first)
  get_filename_component(first ${first} ABSOLUTE)
  set(runner ${CMAKE_CURRENT_BINARY_DIR}/${TEST_NAME}_runner.c)
  add_custom_command(
    OUTPUT ${runner}
    COMMAND ${AGV_RUBY} --disable-gems ${AGV_UNITY}/auto/generate_test_runner.rb ${AGV_CMOCK_CONFIG} ${first} ${runner}
    DEPENDS ${first} ${AGV_CMOCK_CONFIG} ${AGV_GEMS_STAMP}
    COMMENT "Generating the runner of ${TEST_NAME}"
    VERBATIM
  )
  set(mocks)
  foreach(header IN LISTS TEST_MOCKS)
    agv_mock_of(${header} mock)
    list(APPEND mocks ${mock})
  endforeach()

  add_executable(${TEST_NAME} ${TEST_SOURCES} ${runner})
  target_link_libraries(${TEST_NAME} PRIVATE agv_options ${TEST_LIBS} agv_core ${mocks} unity ${AGV_TEST_START})
  target_link_options(${TEST_NAME} PRIVATE -fno-lto) # see host_sim: for so many programs it would take minutes
  # The runner calls the test functions by name, so they are not static and have no prototype.
  set_source_files_properties(${TEST_SOURCES} PROPERTIES COMPILE_OPTIONS -Wno-missing-prototypes)
  set_source_files_properties(${runner} PROPERTIES COMPILE_OPTIONS -w)
  if(TEST_NO_TEST)
    return()
  endif()
  if(TEST_PLANTED)
    set_target_properties(${TEST_NAME} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_test(NAME ${TEST_NAME} CONFIGURATIONS planted COMMAND ${TEST_NAME})
  else()
    add_test(NAME ${TEST_NAME} COMMAND ${TEST_NAME})
  endif()
  get_filename_component(kind ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  # An ignored test function, or a program with none, is a failure.
  set_tests_properties(${TEST_NAME} PROPERTIES LABELS "unity;${kind}" TIMEOUT ${AGV_TEST_TIMEOUT}
    FAIL_REGULAR_EXPRESSION ":IGNORE;(^|\n)0 Tests ")
  if(AGV_INSTRUMENT STREQUAL "mcdc") # a profile a program: scripts/check-mcdc can leave one out
    set_tests_properties(${TEST_NAME} PROPERTIES
      ENVIRONMENT LLVM_PROFILE_FILE=${PROJECT_BINARY_DIR}/profile/${TEST_NAME}.profraw)
  endif()
endfunction()
