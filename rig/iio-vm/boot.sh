#!/usr/bin/env bash
# Boots what build.sh made, with its console on standard output.
#
#   boot.sh FOLDER IIOD_PORT COMMAND_PORT     ports of 127.0.0.1 that lead into the machine
#
# It is emulated in software: no access to /dev/kvm is needed. From outside nothing else leads in, and
# nothing leads out.
set -euo pipefail

folder=${1:?expected the folder of build.sh}
iiod_port=${2:?expected a free port for iiod}
command_port=${3:?expected a free port for commands}

kernel=$(ls "$folder"/kernel/boot/vmlinuz-*)
forward=hostfwd=tcp:127.0.0.1:$iiod_port-10.0.2.15:30431,hostfwd=tcp:127.0.0.1:$command_port-10.0.2.15:30432
exec qemu-system-x86_64 -accel tcg -cpu max -m 768 -smp 1 -nographic -vga none -no-reboot \
  -kernel "$kernel" -initrd "$folder/initrd.zst" \
  -append "console=ttyS0 quiet panic=-1 mitigations=off nokaslr" \
  -netdev "user,id=n0,restrict=on,$forward" -device virtio-net-pci,netdev=n0 < /dev/null
