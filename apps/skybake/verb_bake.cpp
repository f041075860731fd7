#include "program.h"
namespace skybake::cli {
void add_bake(CLI::App&, Program&) {}
}
