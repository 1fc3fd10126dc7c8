// SPDX-License-Identifier: Apache-2.0
#pragma once

extern "C" {
/// How often the program has asked the host for anything: files, console, command line.
unsigned long host_calls();
}
