# The two libFuzzer programs of tests/fuzz: clang only. scripts/check fuzz builds and runs them.
if(NOT CMAKE_C_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "FC_FUZZ needs clang, which libFuzzer is part of (Debian: clang libclang-rt-14-dev); "
                        "name it with CC=clang")
endif()
foreach(name call_sequence state_bytes)
    add_executable(fuzz_${name} tests/fuzz/${name}.c ${fmi_sources} "${variable_table}")
    target_include_directories(fuzz_${name} SYSTEM PRIVATE "${FMI_HEADERS}")
    target_link_libraries(fuzz_${name} PRIVATE friction_core fc_options)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
endforeach()
