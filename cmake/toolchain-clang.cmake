# The newest clang that is installed; a distribution without clang-19 has its own default.
find_program(AGV_CLANG NAMES clang-19 clang REQUIRED)
set(CMAKE_C_COMPILER ${AGV_CLANG})
