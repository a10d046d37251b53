# Compiler and linker options, the same for every target. Contraction to fused multiply-add is off and fast math
# never on, so that every platform computes the same numbers.

# What decides the numbers and the code: fc_numbers. With warnings, for the project's own code: fc_options.
add_library(fc_numbers INTERFACE)
target_compile_options(fc_numbers INTERFACE
    -ffp-contract=off -fno-math-errno -ffunction-sections -fdata-sections $<$<CONFIG:Release>:-O3>)
# gcc clears and copies structures of some hundred bytes by an instruction that is slow to begin, several times in a step. An
# option of the linker, where the code is made; clang-tidy would not know it. What stands behind many checks gcc takes for rare
# and makes small and slow; with the last option it takes it for frequent.
include(CheckLinkerFlag)
set(block_strategy vector_loop:1024:noalign,libcall:-1:noalign)
set(block_options -mmemset-strategy=${block_strategy} -mmemcpy-strategy=${block_strategy}
    --param=hot-bb-frequency-fraction=1000000)
check_linker_flag(C "${block_options}" FC_HAS_BLOCK_STRATEGY)
if(FC_HAS_BLOCK_STRATEGY)
    target_link_options(fc_numbers INTERFACE ${block_options})
endif()
add_library(fc_options INTERFACE)
target_compile_options(fc_options INTERFACE
    -Wall -Wextra -Wpedantic -Wconversion -Wshadow $<$<BOOL:${FC_WERROR}>:-Werror>)
target_link_libraries(fc_options INTERFACE fc_numbers)

# Shared libraries export the fmi2 functions: ELF by the version script, Windows and macOS by what the FMI headers
# declare so while all else is hidden.
add_library(fc_shared INTERFACE)
if(APPLE)
    target_link_options(fc_shared INTERFACE LINKER:-dead_strip)
elseif(UNIX)
    target_link_options(fc_shared INTERFACE
        "LINKER:--version-script=${CMAKE_SOURCE_DIR}/cmake/exports.map" LINKER:--gc-sections)
    if(NOT FC_SANITIZE)
        target_link_options(fc_shared INTERFACE LINKER:-z,defs)
    endif()
endif()

if(FC_SANITIZE)
    target_compile_options(fc_numbers INTERFACE -fsanitize=${FC_SANITIZE} -fno-omit-frame-pointer -g)
    # The panels' loops, inlined and unrolled with every access checked, took most of the build's time.
    target_compile_options(fc_options INTERFACE -Dalways_inline=unused -DFC_NO_UNROLLING)
    target_link_options(fc_numbers INTERFACE -fsanitize=${FC_SANITIZE})
endif()
if(FC_FUZZ)
    # Work that is refused is refused soon, so that a fuzzer can tell a hang. Only the project's own code tells which
    # ways it goes, and not what it compares: that took most of an execution, and there are no magic values to find.
    # What the code takes for granted is asserted.
    target_compile_options(fc_options INTERFACE -fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp
                           -DFC_MAX_EVALUATIONS=2e3 -UNDEBUG)
endif()
if(FC_COVERAGE)
    # A branch counts once, and not once for every place that its function is inlined at.
    target_compile_options(fc_options INTERFACE --coverage -O0 -g -Dalways_inline=unused)
    target_link_options(fc_options INTERFACE --coverage)
endif()

if(CMAKE_BUILD_TYPE STREQUAL "Release" AND NOT FC_SANITIZE AND NOT FC_COVERAGE
   AND NOT DEFINED CMAKE_INTERPROCEDURAL_OPTIMIZATION)
    include(CheckIPOSupported)
    check_ipo_supported(RESULT link_time_optimization LANGUAGES C)
    set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ${link_time_optimization})
endif()

# A link that is killed leaves no file under the library's name, which make would take for current.
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND NOT CMAKE_CROSSCOMPILING)
    string(REPLACE "<TARGET>" "<TARGET>.part" CMAKE_C_CREATE_SHARED_LIBRARY "${CMAKE_C_CREATE_SHARED_LIBRARY}")
    list(APPEND CMAKE_C_CREATE_SHARED_LIBRARY "\"${CMAKE_COMMAND}\" -E rename <TARGET>.part <TARGET>")
endif()

# The loops over the points of a panel a second time, for processors with AVX, under names that end in _avx (fmu_src/solver/panel/arithmetic.h).
function(fc_add_avx core)
    if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64)$")
        return()
    endif()
    set(solver "${CMAKE_SOURCE_DIR}/fmu_src/solver")
    add_library(${core}_avx OBJECT EXCLUDE_FROM_ALL "${solver}/panel/nodes.c" "${solver}/panel/relaxation.c"
                "${solver}/integrate/dense_output.c" "${solver}/body/body_panel.c")
    target_include_directories(${core}_avx PRIVATE "${CMAKE_SOURCE_DIR}/fmu_src")
    target_compile_options(${core}_avx PRIVATE -mavx $<TARGET_PROPERTY:${core},INTERFACE_COMPILE_OPTIONS>)
    target_compile_definitions(${core}_avx PRIVATE
        fc_nodes_make=fc_nodes_make_avx fc_relaxation_panel=fc_relaxation_panel_avx fc_first_upcrossing=fc_first_upcrossing_avx
        fc_body_panel=fc_body_panel_avx fc_body_rates=fc_body_rates_avx fc_body_panel_rates=fc_body_panel_rates_avx)
    target_link_libraries(${core}_avx PRIVATE fc_options)
    target_compile_definitions(${core} PUBLIC FC_WITH_AVX)
    target_sources(${core} PRIVATE $<TARGET_OBJECTS:${core}_avx>)
endfunction()
