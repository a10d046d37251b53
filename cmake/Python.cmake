# Python and fmpy: the generator of the variable table, the packer, and the FMI headers.
# The project's own virtual environment is taken where there is one.

set(venv_python "${CMAKE_SOURCE_DIR}/.venv/bin/python")
if(NOT Python3_EXECUTABLE AND EXISTS "${venv_python}")
    set(Python3_EXECUTABLE "${venv_python}")
endif()
find_package(Python3 3.11 COMPONENTS Interpreter QUIET)
if(NOT Python3_Interpreter_FOUND)
    message(FATAL_ERROR "Python 3.11 or newer is missing: install it (Debian: apt-get install python3), "
                        "or name one with -DPython3_EXECUTABLE=...")
endif()

execute_process(
    COMMAND "${Python3_EXECUTABLE}" -c
            "import fmpy, pathlib; print(pathlib.Path(fmpy.__file__).parent.joinpath('c-code').as_posix(), fmpy.platform, sep=';')"
    OUTPUT_VARIABLE fmpy_answer OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "The Python package fmpy is missing from ${Python3_EXECUTABLE}: run scripts/setup, "
                        "or ${Python3_EXECUTABLE} -m pip install -r requirements.txt")
endif()
list(GET fmpy_answer 0 FMI_HEADERS)
list(GET fmpy_answer 1 fmpy_platform)
set(FMI_PLATFORM "${fmpy_platform}" CACHE STRING "FMI name of the platform built for: linux64, win64, darwin64, ...")
