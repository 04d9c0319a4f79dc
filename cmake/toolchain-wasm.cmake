# WebAssembly with wasi-libc: the simulation as a module for web/. Clang 19, as its libraries have to be of one version.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
find_program(AGV_CLANG NAMES clang-19 REQUIRED)
set(CMAKE_C_COMPILER ${AGV_CLANG})
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_SYSROOT /usr)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_C_FLAGS_INIT "-fno-ident")
