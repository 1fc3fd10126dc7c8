# SPDX-License-Identifier: Apache-2.0
# Writes OUTPUT, a C++ file that defines the functions of HEADER in NAMESPACE, from ASSETS: name;file;name;file…
# The bytes go through hexadecimal, so that no character of a file can be mistaken for C++ or CMake.

set(text "#include \"${HEADER}\"\n\nnamespace ${NAMESPACE} {\n")
while(ASSETS)
    list(POP_FRONT ASSETS name file)
    file(READ "${file}" hex HEX)
    string(LENGTH "${hex}" digit_count)
    math(EXPR byte_count "${digit_count} / 2")
    string(REGEX REPLACE "(................................)" "\\1\n    " hex "${hex}")
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${hex}")
    string(APPEND text
        "\nstatic const unsigned char ${name}_bytes[] = {\n    ${bytes}\n};\n"
        "std::string_view ${name}() {\n"
        "    return {reinterpret_cast<const char*>(${name}_bytes), ${byte_count}};\n}\n")
endwhile()
string(APPEND text "\n}  // namespace ${NAMESPACE}\n")
file(WRITE "${OUTPUT}" "${text}")
