# bash completion of proofmass: asks the program itself (apps/proofmass/cli/completion.hpp).

# Puts the words before the cursor, which bash has cut at ':' and '=' too, together again as they
# were typed: into `typed`.
_proofmass_typed() {
  local line=${COMP_LINE:0:COMP_POINT} rest word k
  typed=()
  for ((k = 0; k <= COMP_CWORD; ++k)); do
    rest=${line#"${line%%[![:space:]]*}"}
    word=${COMP_WORDS[k]}
    ((k == COMP_CWORD)) && word=$rest
    if ((k > 0)) && [[ $rest == "$line" ]]; then
      typed[-1]+=$word
    else
      typed+=("$word")
    fi
    line=${rest#"$word"}
  done
}

# Files behind `prefix`, those of the ending first: into COMPREPLY.
_proofmass_files() {
  local prefix=$1 ending=$2 word=$3 found
  compopt -o filenames 2>/dev/null
  if [[ -n $ending ]]; then
    mapfile -t COMPREPLY < <(compgen -f -X "!*.$ending" -- "${word#"$prefix"}" && compgen -d -- "${word#"$prefix"}")
  fi
  if ((${#COMPREPLY[@]} == 0)); then
    mapfile -t COMPREPLY < <(compgen -f -- "${word#"$prefix"}")
  fi
}

_proofmass() {
  local typed line files='' ending='' prefix='' word cut
  _proofmass_typed
  word=${typed[-1]}
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      :files) files=yes ;;
      ':ending '*) ending=${line#:ending } ;;
      ':prefix '*) prefix=${line#:prefix } ;;
      :*) ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done < <("${typed[0]/#\~/$HOME}" __complete "${typed[@]:1}" 2>/dev/null)
  [[ -n $files ]] && _proofmass_files "$prefix" "$ending" "$word"
  # Of "--unit=m" bash replaces only what is behind the '='.
  if [[ -z $prefix && $word == *[:=]* ]]; then
    cut=${word%"${word##*[:=]}"}
    COMPREPLY=("${COMPREPLY[@]#"$cut"}")
  fi
  [[ ${#COMPREPLY[@]} -eq 1 && ${COMPREPLY[0]} == *[:/] ]] && compopt -o nospace 2>/dev/null
  return 0
}

complete -F _proofmass proofmass
