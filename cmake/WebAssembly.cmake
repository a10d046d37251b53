# The FMI functions as WebAssembly for scripts/playground: a module without main that imports nothing.
add_executable(playground frictionlab/playground/assets/host.c ${fmi_sources} "${variable_table}")
set_target_properties(playground PROPERTIES SUFFIX .wasm)
target_include_directories(playground SYSTEM PRIVATE "${FMI_HEADERS}")
target_link_libraries(playground PRIVATE friction_core fc_options)
target_link_options(playground PRIVATE
    -mexec-model=reactor LINKER:--gc-sections LINKER:--strip-all LINKER:--export-dynamic)
add_dependencies(playground variables)
