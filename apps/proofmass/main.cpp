#include "cli/console.hpp"
#include "cli/run_command.hpp"

int main(int argc, char** argv) {
  proofmass::app::watch_for_interrupts();
  return proofmass::app::run_command(argc, argv);
}
