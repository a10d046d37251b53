# SUNDIALS CVODE as a static library, compiled from its source for every target alike. Gives sundials_cvode_static.
#
# FC_SUNDIALS_SOURCE is shared by all build trees under build/ and filled once, from the distribution's source package.
# Elsewhere than on Debian and its like, name an unpacked source of SUNDIALS 6.

set(FC_SUNDIALS_SOURCE "${CMAKE_SOURCE_DIR}/build/sundials-source" CACHE PATH "Source of SUNDIALS 6")
set(sundials_sources
    src/cvode/cvode.c src/cvode/cvode_io.c src/cvode/cvode_ls.c src/cvode/cvode_nls.c src/cvode/cvode_proj.c
    src/nvector/serial/nvector_serial.c
    src/sundials/sundials_band.c src/sundials/sundials_context.c src/sundials/sundials_dense.c
    src/sundials/sundials_direct.c src/sundials/sundials_iterative.c src/sundials/sundials_linearsolver.c
    src/sundials/sundials_logger.c src/sundials/sundials_math.c src/sundials/sundials_matrix.c
    src/sundials/sundials_memory.c src/sundials/sundials_nonlinearsolver.c src/sundials/sundials_nvector.c
    src/sundials/sundials_nvector_senswrapper.c src/sundials/sundials_version.c
    src/sunlinsol/dense/sunlinsol_dense.c
    src/sunmatrix/band/sunmatrix_band.c src/sunmatrix/dense/sunmatrix_dense.c
    src/sunnonlinsol/newton/sunnonlinsol_newton.c)
list(TRANSFORM sundials_sources PREPEND "${FC_SUNDIALS_SOURCE}/")
set(instead "set -DFC_SUNDIALS_SOURCE to a folder with the source of SUNDIALS 6, or configure with -DWITH_SUNDIALS=OFF")

if(NOT EXISTS "${FC_SUNDIALS_SOURCE}")
    message(STATUS "Fetching SUNDIALS' source (apt-get source, under build/, nothing is installed)")
    execute_process(COMMAND "${Python3_EXECUTABLE}" -B cmake/fetch_sundials.py "${FC_SUNDIALS_SOURCE}"
                    WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}" RESULT_VARIABLE failed ERROR_VARIABLE why)
    if(failed)
        string(STRIP "${why}" why)
        message(FATAL_ERROR "SUNDIALS' source can't be fetched (${why}); ${instead}")
    endif()
endif()
foreach(file CMakeLists.txt include/cvode/cvode.h ${sundials_sources})
    cmake_path(ABSOLUTE_PATH file BASE_DIRECTORY "${FC_SUNDIALS_SOURCE}")
    if(NOT EXISTS "${file}")
        message(FATAL_ERROR "SUNDIALS in ${FC_SUNDIALS_SOURCE} is incomplete, ${file} is missing: "
                            "remove that folder, or ${instead}")
    endif()
endforeach()

file(STRINGS "${FC_SUNDIALS_SOURCE}/CMakeLists.txt" numbers REGEX "PACKAGE_VERSION_[A-Z]+ \"")
foreach(part MAJOR MINOR PATCH)
    string(REGEX MATCH "_${part} \"([0-9]+)\"" found "${numbers}")
    set(sundials_${part} "${CMAKE_MATCH_1}")
endforeach()
if(NOT sundials_MAJOR STREQUAL "6")
    message(FATAL_ERROR "${FC_SUNDIALS_SOURCE} is not SUNDIALS 6, whose functions fmu_src/solver/cvode.c calls: ${instead}")
endif()
configure_file(cmake/sundials_config.h.in generated/sundials/sundials_config.h @ONLY)

add_library(sundials_cvode_static STATIC EXCLUDE_FROM_ALL ${sundials_sources})
target_include_directories(sundials_cvode_static SYSTEM
    PUBLIC "${FC_SUNDIALS_SOURCE}/include" "${CMAKE_BINARY_DIR}/generated"
    PRIVATE "${FC_SUNDIALS_SOURCE}/src/sundials")
target_compile_options(sundials_cvode_static PRIVATE -w)
# It calls by pointers, which no linker inlines; each of the programs that link it would optimize it anew.
set_target_properties(sundials_cvode_static PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
target_link_libraries(sundials_cvode_static PRIVATE fc_numbers PUBLIC m)
