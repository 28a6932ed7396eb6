# Declares libraries, SIMD code and tests. Included once, from the top-level CMakeLists.txt.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release)
endif()

find_program(CCACHE ccache)
if(CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()

# Warnings and sanitizers for our own targets only. -Wrestrict gives false warnings about
# std::string in g++ 12. Without fused multiply-adds the results are the same bytes with and without
# SIMD, on every CPU and on a GPU.
add_library(tessera_options INTERFACE)
target_compile_options(tessera_options INTERFACE -Wall -Wextra -Wshadow -Wconversion
    -Wno-sign-conversion $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> -ffp-contract=off $<$<BOOL:${TESSERA_WERROR}>:-Werror>)
if(TESSERA_SANITIZE)
    target_compile_options(tessera_options INTERFACE -fsanitize=${TESSERA_SANITIZE}
        -fno-omit-frame-pointer -fno-sanitize-recover=all)
    if(TESSERA_SANITIZE MATCHES undefined)
        # ASan finds null pointers and objects that are too small by itself. These checks stand at
        # every access to memory and take a third of the compile time. Alignment is checked in
        # targets with the property TESSERA_CHECKS_ALIGNMENT: those that read bytes from outside.
        target_compile_options(tessera_options INTERFACE -fno-sanitize=null,object-size
            $<$<NOT:$<BOOL:$<TARGET_PROPERTY:TESSERA_CHECKS_ALIGNMENT>>>:-fno-sanitize=alignment>)
    endif()
    target_link_options(tessera_options INTERFACE -fsanitize=${TESSERA_SANITIZE})
    # The same as without a sanitizer. Otherwise Eigen's out-of-line functions allocate one way here
    # and Ceres' static library frees another way.
    target_compile_definitions(tessera_options INTERFACE EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# For libraries that the Python module links. With hidden symbols, position-independent code is as
# fast as a program's: calls and inlining within a library do not change.
function(tessera_for_python target)
    if(TESSERA_PYTHON)
        set_target_properties(${target} PROPERTIES
            POSITION_INDEPENDENT_CODE ON CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
    endif()
endfunction()

# tessera_library(NAME SOURCES... LINK libs...) declares the library of a folder under src/.
function(tessera_library name)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
    add_library(${name} STATIC ${ARG_SOURCES})
    set_property(GLOBAL APPEND PROPERTY TESSERA_LIBRARIES ${name})
    target_include_directories(${name} PUBLIC
        $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include/tessera>)
    target_link_libraries(${name} PUBLIC ${ARG_LINK} PRIVATE ${ARG_PRIVATE_LINK} tessera_options)
    tessera_for_python(${name})
endfunction()

# tessera_vector_source(LIBRARY FILE) compiles FILE a second time for AVX2 (not for FMA, see above).
# The file must not include Eigen and must export one function in namespace
# tessera::TESSERA_VECTOR_NAMESPACE. The caller selects one at run time.
function(tessera_vector_source library file)
    get_filename_component(stem ${file} NAME_WE)
    foreach(arch baseline avx2)
        set(unit ${library}_${stem}_${arch})
        add_library(${unit} OBJECT ${file})
        target_include_directories(${unit} PRIVATE ${CMAKE_SOURCE_DIR}/src)
        target_compile_definitions(${unit} PRIVATE TESSERA_VECTOR_NAMESPACE=${arch})
        target_link_libraries(${unit} PRIVATE tessera_options)
        tessera_for_python(${unit})
        if(arch STREQUAL avx2)
            if(NOT CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
                continue()
            endif()
            target_compile_options(${unit} PRIVATE -mavx2)
            target_compile_definitions(${library} PRIVATE TESSERA_HAVE_AVX2)
        endif()
        target_sources(${library} PRIVATE $<TARGET_OBJECTS:${unit}>)
    endforeach()
endfunction()

# The test programs that a sanitizer build needs.
add_custom_target(tessera_sanitized_tests)
# Each test program writes its results here as XML. scripts/summarise_tests.py counts the tests.
set(TESSERA_TEST_RESULTS ${CMAKE_BINARY_DIR}/test_results)

# tessera_test(NAME SOURCES... LINK libs... [LABEL unit|data|slow|app|window] [THREADS patterns...]
#              [SERIAL] [ISOLATED] [SHARDS n] [LONG patterns...]) declares a GoogleTest program. It is
# one ctest entry, not one per test, because a process takes 0.2 s to start. SHARDS splits a long
# program into n entries that may run at the same time. ISOLATED gives each test a process: for
# libraries that cannot be started twice in one. SERIAL is for programs that depend on timing: no
# other test runs at the same time.
#
# ASan runs the unit programs, TSan all with THREADS, which lists the tests, as GoogleTest filters,
# that start threads of ours. TBB's loops are serial under TSan (tests/support/serial_tbb.cpp), so it
# has nothing to find in the others. LONG lists tests that take
# seconds: they are an entry of their own with the label slow, and the sanitizers skip them, because
# shorter tests cover the same code.
function(tessera_test name)
    cmake_parse_arguments(ARG "SERIAL;ISOLATED" "LABEL;SHARDS" "SOURCES;LINK;LONG;THREADS" ${ARGN})
    if(NOT ARG_LABEL)
        set(ARG_LABEL unit)
    endif()
    if(NOT ARG_SHARDS)
        set(ARG_SHARDS 1)
    endif()
    add_executable(${name} ${ARG_SOURCES})
    target_include_directories(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests)
    target_link_libraries(${name} PRIVATE ${ARG_LINK} GTest::gtest_main tessera_options)
    target_compile_options(${name} PRIVATE -O1)  # compiles faster; the code under test keeps its level
    if(TESSERA_SANITIZE MATCHES address)
        target_sources(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/support/leaks.cpp)
        target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
    endif()
    if(TESSERA_SANITIZE MATCHES thread)
        target_sources(${name} PRIVATE ${CMAKE_SOURCE_DIR}/tests/support/serial_tbb.cpp)
        target_link_libraries(${name} PRIVATE TBB::tbb)
    endif()

    set(label ${ARG_LABEL})
    set(filter "")
    if((TESSERA_SANITIZE MATCHES thread AND ARG_THREADS) OR
       (ARG_LABEL STREQUAL unit AND NOT TESSERA_SANITIZE MATCHES thread))
        add_dependencies(tessera_sanitized_tests ${name})
        set(label unit-sanitized)  # ctest -L unit and ctest -L sanitized both find it
    endif()
    if(TESSERA_SANITIZE MATCHES thread)
        list(JOIN ARG_THREADS ":" filter)
    endif()
    if(ARG_LONG)
        list(JOIN ARG_LONG ":" patterns)
        string(APPEND filter "-${patterns}")
        if(NOT TESSERA_SANITIZE)
            tessera_test_entry(${name}.long ${name} slow "${patterns}" 1 0)
        endif()
    endif()
    if(ARG_ISOLATED)
        gtest_discover_tests(${name} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 TEST_FILTER "${filter}"
            PROPERTIES LABELS ${label} TIMEOUT 900 RUN_SERIAL ${ARG_SERIAL})
        return()
    endif()
    math(EXPR last "${ARG_SHARDS} - 1")
    foreach(shard RANGE ${last})
        set(entry ${name})
        if(ARG_SHARDS GREATER 1)
            set(entry ${name}.${shard})
        endif()
        tessera_test_entry(${entry} ${name} ${label} "${filter}" ${ARG_SHARDS} ${shard})
        set_tests_properties(${entry} PROPERTIES RUN_SERIAL ${ARG_SERIAL})
    endforeach()
endfunction()

# A ctest entry that runs the tests of `filter` (empty: all) in one shard of a program.
function(tessera_test_entry entry program label filter shards shard)
    set(filter_argument "")
    if(filter)
        set(filter_argument --gtest_filter=${filter})
    endif()
    set(cost 0)
    if(label MATCHES "slow|data|app")
        set(cost 100)  # ctest starts these first, so that none is left alone at the end
    endif()
    add_test(NAME ${entry} COMMAND ${program} --gtest_brief=1 ${filter_argument}
        --gtest_output=xml:${TESSERA_TEST_RESULTS}/${entry}.xml)
    set_tests_properties(${entry} PROPERTIES LABELS ${label} TIMEOUT 900 COST ${cost}
        ENVIRONMENT "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${shard}")
endfunction()
