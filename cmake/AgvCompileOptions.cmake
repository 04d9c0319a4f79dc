# How this project's own code is compiled. Link `agv_options` (PRIVATE) to get it; generated and foreign code does not.

option(AGV_WARNINGS_AS_ERRORS "Warnings in the project's own code are errors" ON)
option(AGV_QUICK_BUILD "Build host_sim alone, and quickly: see host_sim" OFF)
set(AGV_INSTRUMENT "" CACHE STRING "Instrumentation: empty, sanitize, coverage, mcdc, mutation, fuzz or profile")
set_property(CACHE AGV_INSTRUMENT PROPERTY STRINGS "" sanitize coverage mcdc mutation fuzz profile)

add_library(agv_options INTERFACE)
target_compile_options(agv_options INTERFACE
  -Wall -Wextra -Wpedantic
  -Wshadow -Wundef -Wvla -Wunused -Wwrite-strings
  -Wconversion -Wsign-conversion -Wdouble-promotion -Wfloat-equal
  -Wcast-qual -Wcast-align -Wpointer-arith
  -Wstrict-prototypes -Wmissing-prototypes -Wold-style-definition
  -Wformat=2 -Wimplicit-fallthrough
  -Walloca
  $<$<NOT:$<OR:$<BOOL:${AGV_PROFILE}>,$<STREQUAL:${AGV_INSTRUMENT},profile>>>:-Wnull-dereference> # a profile makes it guess
  $<$<C_COMPILER_ID:GNU>:-Wlogical-op -Wduplicated-cond -Wduplicated-branches -Wtrampolines>
  $<$<C_COMPILER_ID:Clang>:-Wcomma -Wunreachable-code -Wconditional-uninitialized -Wextra-semi>
)
if(AGV_WARNINGS_AS_ERRORS AND NOT AGV_QUICK_BUILD) # the demo also builds with a compiler that warns of more
  target_compile_options(agv_options INTERFACE -Werror)
endif()

set(AGV_CORE_KIND STATIC)
# No path of the machine that builds is in a program.
add_compile_options(-fmacro-prefix-map=${PROJECT_SOURCE_DIR}/=)
# Instrumentation is for everything that is linked, generated code included: a mock must not hide an overflow.
if(AGV_INSTRUMENT STREQUAL "sanitize")
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
elseif(AGV_INSTRUMENT STREQUAL "coverage")
  add_compile_options(--coverage)
  add_link_options(--coverage)
elseif(AGV_INSTRUMENT STREQUAL "fuzz")
  if(NOT CMAKE_C_COMPILER_ID STREQUAL "Clang")
    message(FATAL_ERROR "AGV_INSTRUMENT is fuzz: only clang has libFuzzer")
  endif()
  # strict: an array at the end of a struct has bounds too
  add_compile_options(-fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
    -fstrict-flex-arrays=3)
  add_link_options(-fsanitize=address,undefined)
elseif(AGV_INSTRUMENT STREQUAL "mcdc")
  # clang only, and only for the core: the tests' own decisions do not count and would make the run slower.
  set(AGV_CORE_INSTRUMENT_OPTIONS -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc)
  add_link_options(-fprofile-instr-generate)
elseif(AGV_INSTRUMENT STREQUAL "mutation")
  # The core is one shared object, which tests/proofs/mutation replaces. A test may lack functions of the port.
  set(AGV_CORE_KIND SHARED)
  set(CMAKE_SKIP_RPATH ON)
  add_link_options(-Wl,--allow-shlib-undefined)
elseif(AGV_INSTRUMENT STREQUAL "profile") # see AgvProfile.cmake
  add_compile_options(-fprofile-generate -fprofile-update=single)
  add_link_options(-fprofile-generate)
elseif(NOT AGV_INSTRUMENT STREQUAL "")
  message(FATAL_ERROR
    "AGV_INSTRUMENT is '${AGV_INSTRUMENT}': it must be empty, sanitize, coverage, mcdc, mutation, fuzz or profile")
endif()
