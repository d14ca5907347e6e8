#!/usr/bin/env bash
# Builds the virtual machine that tests sources against the kernel's own drivers.
#
#   build.sh FOLDER PROGRAM     kernel and initial file system into FOLDER; PROGRAM is taken along
#
# The kernel is Debian's 6.12 (bookworm-security), fetched once into FOLDER: 107 MB. What is there
# already is kept. Exits 77 with a sentence where something to build with is missing.
set -euo pipefail

folder=${1:?expected a folder to build in}
program=$(realpath "${2:?expected the program to take along}")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
mkdir -p "$folder"
folder=$(realpath "$folder")

skip() {
  printf 'iio-vm: %s\n' "$*"
  exit 77
}

for tool in qemu-system-x86_64 busybox cpio zstd depmod gcc iiod xz; do
  PATH=$PATH:/usr/sbin:/sbin command -v "$tool" > /dev/null || skip "$tool is missing: tools/setup.sh test"
done
PATH=$PATH:/usr/sbin:/sbin

modules=(i2c-stub i2c-dev kxcjk-1013 st_accel_i2c bmc150-accel-i2c iio-trig-hrtimer virtio_net comedi_test)

fetch_kernel() {
  [[ -e $folder/kernel.fetched ]] && return
  local package
  package=$(apt-cache depends linux-image-6.12-amd64 2> /dev/null | sed -n 's/^ *Depends: \(linux-image-6.12.*\)/\1/p' | head -1)
  [[ -n $package ]] || skip "no package linux-image-6.12-amd64 is known here: it is Debian's (bookworm-security); apt-get update"
  rm -rf "$folder/kernel" "$folder/fetch"
  mkdir -p "$folder/fetch"
  (cd "$folder/fetch" && apt-get download "$package" > log 2>&1) || skip "$package was not fetched: $(tail -1 "$folder/fetch/log")"
  dpkg-deb -x "$folder"/fetch/*.deb "$folder/kernel"
  depmod -b "$folder/kernel" "$(ls "$folder/kernel/lib/modules")"
  rm -rf "$folder/fetch"
  touch "$folder/kernel.fetched"
}

# Each module once, behind those that it needs.
put_modules() {
  local version path name options
  version=$(ls "$folder/kernel/lib/modules")
  mkdir -p "$1/modules"
  for name in "${modules[@]}"; do
    modprobe -d "$folder/kernel" -S "$version" --show-depends "$name"
  done | awk '$1 == "insmod" && !seen[$2]++ { print $2 }' | while read -r path; do
    name=$(basename "$path" .xz)
    options=
    [[ $name == i2c-stub.ko ]] && options=chip_addr=0x0f,0x10,0x18
    xz -dc "$path" > "$1/modules/$name"
    echo "$name $options" >> "$1/modules/order"
  done
}

# A program and the libraries that it is linked with, where its loader looks for them.
put_program() {
  local root=$1 from=$2 to=$3 library
  install -D -m 755 "$from" "$root$to"
  ldd "$from" | grep -o '/[^ ]*' | sort -u | while read -r library; do
    [[ -e $root$library ]] || install -D -m 755 "$library" "$root$library"
  done
}

make_root() {
  local root=$1
  mkdir -p "$root"/{bin,sbin,proc,sys,dev,tmp,etc,run,lib,lib64,usr/lib}
  cp "$(command -v busybox)" "$root/bin/busybox"
  gcc -O2 -static -o "$root/bin/accelgen" "$here/accelgen.c" -lm
  put_program "$root" "$(command -v iiod)" /sbin/iiod
  put_program "$root" "$program" /bin/proofmass
  put_modules "$root"
  install -m 755 "$here/init" "$root/init"
  install -m 755 "$here/serve" "$root/bin/serve"
}

fetch_kernel
fresh="$program $here/init $here/serve $here/accelgen.c $here/build.sh"
if [[ ! -e $folder/initrd.zst ]] || [[ -n $(find $fresh -newer "$folder/initrd.zst") ]]; then
  rm -rf "$folder/root"
  make_root "$folder/root"
  (cd "$folder/root" && find . | cpio -o -H newc --quiet) | zstd -q -3 -f -o "$folder/initrd.part"
  rm -rf "$folder/root"
  mv "$folder/initrd.part" "$folder/initrd.zst"
fi
