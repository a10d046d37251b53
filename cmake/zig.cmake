# Toolchain file: zig's C compiler for any platform of the release, chosen by its FMI name.
#
#     cmake -S . -B FOLDER --toolchain cmake/zig.cmake -DFMI_PLATFORM=aarch64-linux -DZIG=.../ziglang/zig
#
# Folder names as in FMI 2.0.5, section 2.3: linux64, win64, darwin64 mean x86-64; every other platform has the
# platform tuple of FMI 3.0, section 2.5.1.4.1.
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ZIG FMI_PLATFORM)

if(FMI_PLATFORM STREQUAL "linux64")
    set(triple x86_64-linux-gnu.2.17)
elseif(FMI_PLATFORM STREQUAL "aarch64-linux")
    set(triple aarch64-linux-gnu.2.17)
elseif(FMI_PLATFORM STREQUAL "win64")
    set(triple x86_64-windows-gnu)
elseif(FMI_PLATFORM STREQUAL "darwin64")
    set(triple x86_64-macos.10.15)
elseif(FMI_PLATFORM STREQUAL "aarch64-darwin")
    set(triple aarch64-macos.11.0)
else()
    message(FATAL_ERROR "unknown FMI_PLATFORM ${FMI_PLATFORM}")
endif()

string(REGEX MATCH "^([^-]+)-([a-z]+)" system "${triple}")
set(CMAKE_SYSTEM_PROCESSOR "${CMAKE_MATCH_1}")
set(system_of_linux Linux)
set(system_of_windows Windows)
set(system_of_macos Darwin)
set(CMAKE_SYSTEM_NAME "${system_of_${CMAKE_MATCH_2}}")

set(CMAKE_C_COMPILER "${ZIG}" cc -target ${triple})
# CMake tries the compiler without optimization, for which zig would first make its library of sanitizers.
set(CMAKE_C_FLAGS_INIT -fno-sanitize=undefined)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s)
# zig's linkers for the other formats take no code that is yet to be optimized.
set(CMAKE_INTERPROCEDURAL_OPTIMIZATION ON)
if(CMAKE_SYSTEM_NAME MATCHES "Windows|Darwin")
    set(CMAKE_INTERPROCEDURAL_OPTIMIZATION OFF)
endif()
set(FC_WERROR OFF CACHE BOOL "The default build holds the code free of warnings; a newer clang's stop no release")
set(CMAKE_OSX_DEPLOYMENT_TARGET "" CACHE STRING "the triple says it")
set(CMAKE_INSTALL_NAME_TOOL "${CMAKE_COMMAND}" CACHE FILEPATH "asked for, never called: nothing is installed")

# CMake calls the archiver by one word.
foreach(tool ar ranlib)
    set(program "${CMAKE_BINARY_DIR}/zig-${tool}")
    file(WRITE "${program}" "#!/bin/sh\nexec '${ZIG}' ${tool} \"$@\"\n")
    file(CHMOD "${program}" PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE)
    string(TOUPPER ${tool} name)
    set(CMAKE_${name} "${program}")
    set(CMAKE_C_COMPILER_${name} "${program}")
endforeach()
