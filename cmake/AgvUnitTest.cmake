# Unit tests with Unity and CMock.
#
#   agv_add_unit_test(NAME test_gate SOURCES test_gate.c [more.c ...] [MOCKS hal/can.h ...] [LIBS hal_sim ...] [SEEDED]
#     [NO_TEST])
#
# Builds one program from the sources, a runner generated from the first of them, and the generated mocks, and adds it
# to ctest. A test includes a mock as "mock_can.h" (for hal/can.h). Every program is linked to agv_core.
# Mocks replace only the HAL contract, hal/include; the core is tested unchanged.
# NO_TEST: the program is built, and another test runs it.
# SEEDED: a test that must fail; it is built only by its name and run only by `ctest -C seeded` (tests/proofs/seeded.tsv).

find_program(AGV_RUBY ruby)
set(AGV_GEMS ${PROJECT_SOURCE_DIR}/build/gems)
set(AGV_UNITY ${AGV_GEMS}/vendor/unity)
set(AGV_CMOCK ${AGV_GEMS}/vendor/cmock)
set(AGV_CMOCK_CONFIG ${PROJECT_SOURCE_DIR}/tests/cmock.yml)
set(AGV_TEST_TIMEOUT 120 CACHE STRING "Seconds after which a test program is stuck")
set(AGV_MOCK_DIR ${PROJECT_BINARY_DIR}/mocks)

# Without Ruby the programs still build (target host_sim and others); only the tests need it, when they are built.
if(NOT AGV_RUBY)
  set(AGV_RUBY ruby)
endif()

# All build trees share the gems. Compiled files are copied, so that `clean` keeps the gems.
set(AGV_GEMS_STAMP ${PROJECT_BINARY_DIR}/gems.stamp)
add_custom_command(
  OUTPUT ${AGV_GEMS_STAMP}
  COMMAND ${PROJECT_SOURCE_DIR}/scripts/tools/bundle-gems.sh
  COMMAND ${CMAKE_COMMAND} -E touch ${AGV_GEMS_STAMP}
  DEPENDS ${PROJECT_SOURCE_DIR}/Gemfile.lock ${PROJECT_SOURCE_DIR}/scripts/tools/bundle-gems.sh
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
  target_sources(unity PRIVATE ${PROJECT_SOURCE_DIR}/tests/proofs/mutation/stop_at_failure.c)
  target_compile_definitions(unity PRIVATE "UNITY_OUTPUT_FLUSH=agv_stop_at_failure"
    "UNITY_OUTPUT_FLUSH_HEADER_DECLARATION=agv_stop_at_failure(void)")
endif()

# The library target of the mock of a header of the HAL contract, created at its first use.
function(agv_mock_of HEADER TARGET_VARIABLE)
  if(NOT HEADER MATCHES "^hal/([a-z_]+)\\.h$" OR NOT EXISTS ${PROJECT_SOURCE_DIR}/hal/include/${HEADER})
    message(FATAL_ERROR "'${HEADER}' cannot be mocked: mocks replace only headers of hal/include")
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

# The runner of a test is a header that is included before the test, so that both are compiled at once. The runners of a
# folder are made together.
function(agv_runner_of SOURCE RUNNER_VARIABLE)
  get_filename_component(name ${SOURCE} NAME_WE)
  get_filename_component(path ${SOURCE} ABSOLUTE)
  set(runner ${CMAKE_CURRENT_BINARY_DIR}/${name}_runner.h)
  set(${RUNNER_VARIABLE} ${runner} PARENT_SCOPE)
  set_source_files_properties(${SOURCE} PROPERTIES COMPILE_OPTIONS "-include;${runner}" OBJECT_DEPENDS ${runner})
  get_property(tests DIRECTORY PROPERTY AGV_TESTS)
  if(NOT tests)
    cmake_language(DEFER CALL agv_make_runners)
  endif()
  if(NOT path IN_LIST tests)
    set_property(DIRECTORY APPEND PROPERTY AGV_TESTS ${path})
  endif()
endfunction()

# At the end of a folder, when all its tests are known.
function(agv_make_runners)
  get_property(tests DIRECTORY PROPERTY AGV_TESTS)
  set(runners)
  foreach(test IN LISTS tests)
    get_filename_component(name ${test} NAME_WE)
    list(APPEND runners ${CMAKE_CURRENT_BINARY_DIR}/${name}_runner.h)
  endforeach()
  set(maker ${PROJECT_SOURCE_DIR}/tests/make_runners.rb)
  add_custom_command(
    OUTPUT ${runners}
    COMMAND ${AGV_RUBY} --disable-gems -r ${AGV_UNITY}/auto/generate_test_runner.rb ${maker} ${AGV_CMOCK_CONFIG}
      ${CMAKE_CURRENT_BINARY_DIR} ${tests}
    DEPENDS ${tests} ${maker} ${AGV_CMOCK_CONFIG} ${AGV_GEMS_STAMP}
    COMMENT "Generating the runners of the tests"
    VERBATIM
  )
endfunction()

function(agv_add_unit_test)
  cmake_parse_arguments(PARSE_ARGV 0 TEST "SEEDED;NO_TEST" "NAME" "SOURCES;MOCKS;LIBS")
  if(NOT TEST_NAME OR NOT TEST_SOURCES OR TEST_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "usage: agv_add_unit_test(NAME name SOURCES file.c ... [MOCKS hal/x.h ...] [LIBS lib ...])")
  endif()
  list(GET TEST_SOURCES 0 first)
  agv_runner_of(${first} runner)
  set(mocks)
  foreach(header IN LISTS TEST_MOCKS)
    agv_mock_of(${header} mock)
    list(APPEND mocks ${mock})
  endforeach()

  add_executable(${TEST_NAME} ${TEST_SOURCES} ${runner})
  target_link_libraries(${TEST_NAME} PRIVATE agv_options ${TEST_LIBS} agv_core ${mocks} unity ${AGV_TEST_START})
  target_link_options(${TEST_NAME} PRIVATE -fno-lto) # see host_sim: for so many programs it would take minutes
  if(TEST_NO_TEST)
    return()
  endif()
  if(TEST_SEEDED)
    set_target_properties(${TEST_NAME} PROPERTIES EXCLUDE_FROM_ALL ON)
    add_test(NAME ${TEST_NAME} CONFIGURATIONS seeded COMMAND ${TEST_NAME})
  else()
    add_test(NAME ${TEST_NAME} COMMAND ${TEST_NAME})
  endif()
  set(kind ${AGV_TEST_KIND}) # the room of tests/ that it lies in, if its folder says no other
  if(NOT kind)
    file(RELATIVE_PATH kind ${PROJECT_SOURCE_DIR}/tests ${CMAKE_CURRENT_SOURCE_DIR})
    string(REGEX REPLACE "/.*" "" kind ${kind})
  endif()
  # An ignored test function, or a program with none, is a failure.
  set_tests_properties(${TEST_NAME} PROPERTIES LABELS "unity;${kind}" TIMEOUT ${AGV_TEST_TIMEOUT}
    FAIL_REGULAR_EXPRESSION ":IGNORE;(^|\n)0 Tests ")
  if(AGV_INSTRUMENT STREQUAL "mcdc") # a profile a program: tests/proofs/mcdc/check-mcdc.py can leave one out
    set_tests_properties(${TEST_NAME} PROPERTIES
      ENVIRONMENT LLVM_PROFILE_FILE=${PROJECT_BINARY_DIR}/profile/${TEST_NAME}.profraw)
  endif()
endfunction()
