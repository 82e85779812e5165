# Sourced by release_trials.sh: the steps of the Containerfile in the Debian at $root, which is what it is made from.

# copy_into CONTEXT NAMES... FOLDER/: what COPY does.
copy_into() {
  local context=$1 folder=${!#} name
  mkdir -p "$root$folder"
  for name in "${@:2:$#-2}"; do
    compgen -G "$context/$name" >/dev/null || die "Containerfile: COPY finds no $name"
    cp "$context"/$name "$root$folder"
  done
}

# build_container CONTEXT: carries out every step, and sets $container_folder and $container_entry.
build_container() {
  local instruction rest
  container_folder=/ container_entry=
  while read -r instruction rest; do
    case $instruction in
      FROM) [[ $rest == debian:12-slim ]] || die "Containerfile: FROM $rest is not the Debian that this is tried on" ;;
      COPY) eval "copy_into \"\$1\" ${rest//\*/\\*}" ;;
      RUN) quietly "Containerfile: RUN" inside "cd $container_folder && sh -c $(printf %q "$rest")" ;;
      WORKDIR) mkdir -p "$root$rest" && container_folder=$rest ;;
      ENTRYPOINT) container_entry=$(tr -d '[]",' <<<"$rest") ;;
      *) die "Containerfile: $instruction is a step that scripts/container.sh does not know" ;;
    esac
  done < <(sed '/^#/d' Containerfile | sed -e ':a' -e '/\\$/{N;s/\\\n//;ba}')
  [[ -n $container_entry ]] || die "Containerfile: no ENTRYPOINT"
}

# in_container ARGUMENTS...: what `podman run` runs.
in_container() { inside "cd $container_folder && $container_entry $*"; }
