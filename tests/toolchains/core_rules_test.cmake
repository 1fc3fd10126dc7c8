# SPDX-License-Identifier: Apache-2.0
# Proves that the search of the core finds every forbidden word, at its line, in every folder of the core, and that
# comments, literals and deleted functions do not trip it. Needs CORE_RULES (the script) and WORK_DIR (scratch).
cmake_minimum_required(VERSION 3.25)

set(failures "")

# Searches a tree that holds `code` in `file`; sets `exit_code` and `message`.
function(search_tree file code)
    file(REMOVE_RECURSE "${WORK_DIR}")
    file(WRITE "${WORK_DIR}/${file}" "${code}")
    execute_process(COMMAND ${CMAKE_COMMAND} "-DSOURCE_DIR=${WORK_DIR}" -P "${CORE_RULES}"
        RESULT_VARIABLE exit_code OUTPUT_VARIABLE message ERROR_VARIABLE message)
    set(exit_code "${exit_code}" PARENT_SCOPE)
    set(message "${message}" PARENT_SCOPE)
endfunction()

function(expect_finding file code line word)
    search_tree("${file}" "${code}")
    string(FIND "${message}" "${file}:${line}: '${word}' is forbidden" place)
    if(exit_code EQUAL 0 OR place EQUAL -1)
        set(failures "${failures}  not found: ${word} at ${file}:${line} in: ${code}\n" PARENT_SCOPE)
    endif()
endfunction()

function(expect_clean code)
    search_tree("hal/include/hal/clean.hpp" "${code}")
    if(NOT exit_code EQUAL 0)
        set(failures "${failures}  found where nothing is: ${code}\n${message}" PARENT_SCOPE)
    endif()
endfunction()

foreach(word IN ITEMS
        new delete malloc calloc realloc free alloca throw try catch dynamic_cast typeid double goto
        std::vector std::string std::map std::unordered_map std::set std::list std::deque std::function
        std::shared_ptr std::unique_ptr std::make_shared std::make_unique std::any std::thread std::mutex
        std::cout std::cerr printf MatrixXf MatrixXd VectorXf VectorXd Dynamic)
    expect_finding(estimation/include/estimation/a.hpp "int a[2];\n\nb(${word}<c>(d));\n" 3 ${word})
endforeach()

foreach(folder IN ITEMS hal/include/hal estimation/src estimation/include/estimation/detail control/include/control
        firmware/include/firmware firmware/src)
    expect_finding(${folder}/a.hpp "double x;\n" 1 double)
    expect_finding(${folder}/a.cpp "double x;\n" 1 double)
endforeach()

set(header hal/include/hal/a.hpp)
expect_finding(${header} "long double x;\n" 1 double)
expect_finding(${header} "double" 1 double)
expect_finding(${header} "char c = ';'; int a[] = {1}; double x; // ]\n" 1 double)
expect_finding(${header} "int a[3;\nint b;\ndouble x;\n" 3 double)
expect_finding(${header} "f(\"//\", new int);\n" 1 new)
expect_finding(${header} "f('\"', new int, '\"');\n" 1 new)
expect_finding(${header} "f(\"a\\\\\", new int, \"b\");\n" 1 new)
expect_finding(${header} "/* a\n b */ throw 1;\n" 2 throw)
expect_finding(${header} "// a comment with /* in it\nthrow 1;\n" 2 throw)
expect_finding(${header} "f(\"/*\");\nthrow 1;\n" 2 throw)
expect_finding(${header} "x = a ? new int : b;\ndelete x;\n" 2 delete)
expect_finding(${header} "#define two(a) \\\n    new a\n" 2 new)

expect_clean("A(const A&) = delete;\nA& operator=(const A&) =delete;\nA() = default;\n")
expect_clean("/// no new, no double; [free]\nint a; // throw\n/* try */ int b; /* catch\n goto\n double */ int c;\n")
expect_clean("f(\"new double; // try\", 'n', \"a \\\" free\");\n")
expect_clean("constexpr float half = static_cast<float>(0.5L);\n")
expect_clean("#include <array>\n#include <new>\nstd::array<float, 3> a{};\nstd::string_view s;\n")
expect_clean("int renewed = newest + free_A + double_count + retry;\nVectorXf4 v;\nint million = 1'000'000;\n")

foreach(folder IN ITEMS sim/cutting estimation/calibration/src
        estimation/calibration/include/estimation_calibration)
    search_tree(${folder}/a.cpp "#include \"estimation_calibration/a.hpp\"\nstd::vector<double> x;\n")
    if(NOT exit_code EQUAL 0)
        string(APPEND failures "  the host's code in ${folder} was searched\n")
    endif()
endforeach()

foreach(include IN ITEMS "#include \"estimation_calibration/a.hpp\"" "  # include <estimation_calibration/a.hpp>")
    search_tree(firmware/src/a.cpp "int a\;\n${include}\n")
    if(exit_code EQUAL 0 OR NOT "${message}" MATCHES "firmware/src/a.cpp:2: a header of the host")
        string(APPEND failures "  not found: ${include} in the core\n")
    endif()
endforeach()

file(REMOVE_RECURSE "${WORK_DIR}")
if(failures)
    message(FATAL_ERROR "The search of the core is wrong:\n${failures}")
endif()
