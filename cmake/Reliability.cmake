# Programs that scripts/check builds and runs: the soak, the fuzzers' inputs given once, and with FC_FUZZ the fuzzers.
add_executable(soak EXCLUDE_FROM_ALL tests/soak/soak.c host/fmi2_linked.c "${variable_table}")
target_include_directories(soak PRIVATE fmu_src tests)
target_link_libraries(soak PRIVATE FrictionContact fmi2_library fc_options m)

if(CMAKE_SYSTEM_NAME STREQUAL "Linux") # it forks, and reads another process's clock
    add_executable(watchdog EXCLUDE_FROM_ALL tests/fuzz/watchdog.c host/fmi2_linked.c)
    target_include_directories(watchdog PRIVATE tests)
    target_compile_definitions(watchdog PRIVATE _GNU_SOURCE)
    target_link_libraries(watchdog PRIVATE core_with_asserts fmi2_library fc_options)
    set_target_properties(watchdog PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
endif()

if(FC_FUZZ AND NOT CMAKE_C_COMPILER_ID MATCHES "Clang")
    message(FATAL_ERROR "FC_FUZZ needs clang, which libFuzzer is part of (Debian: clang libclang-rt-14-dev); "
                        "name it with CC=clang")
endif()
add_library(fuzzed OBJECT EXCLUDE_FROM_ALL host/fmi2_linked.c ${fmi_sources} "${variable_table}")
target_link_libraries(fuzzed PUBLIC friction_core fmi2_library PRIVATE fc_options)
add_dependencies(fuzzed variables)
foreach(name call_sequence model_exchange state_bytes)
    add_executable(fuzz_${name} EXCLUDE_FROM_ALL tests/fuzz/${name}.c)
    target_link_libraries(fuzz_${name} PRIVATE fuzzed fc_options)
    target_link_options(fuzz_${name} PRIVATE -fsanitize=fuzzer)
    # With the core of the unit tests, which holds asserts and is linked in no time.
    add_executable(replay_${name} EXCLUDE_FROM_ALL tests/fuzz/${name}.c tests/fuzz/replay.c host/fmi2_linked.c)
    target_link_libraries(replay_${name} PRIVATE core_with_asserts fmi2_library fc_options)
    set_target_properties(replay_${name} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
    foreach(program fuzz_${name} replay_${name})
        target_include_directories(${program} PRIVATE tests)
    endforeach()
endforeach()
