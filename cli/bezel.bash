# Completion of bezel's commands, options and files for bash. The words come from the tool's own --help.
_bezel() {
  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command='' w
  for w in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    if [[ $w != -* ]]; then
      command=$w
      break
    fi
  done
  local words=''
  if [[ $word == -* ]]; then
    words=$({
      "${COMP_WORDS[0]}" $command --help
      "${COMP_WORDS[0]}" --help
    } 2>/dev/null | grep -oE -- '--[a-z][a-z-]*' | sort -u)
  elif [[ -z $command ]]; then
    words=$("${COMP_WORDS[0]}" --help 2>/dev/null | sed -n '/^Subcommands:/,$ s/^  \([a-z]\+\) .*/\1/p')
  else
    case $previous in
      mesh) words='square rectangle disc annulus lshape curves' ;;
      study) words='transfer compensated newton curves' ;;
      --method) words='standard chord arclength l2 equal-tangent orthogonal-distance best' ;;
      --precision) words='1 2 3 4 certified' ;;
      --newton) words='basic accurate full triple' ;;
      --basis) words='reference physical' ;;
      --continuity) words='dg cg' ;;
      --mass-method) words='auto cholesky conjugate_gradients petsc' ;;
      --uncovered) words='error extend zero' ;;
      --bounds) words='local none' ;;
      --conserve) words='covered total' ;;
      --pattern) words='structured unstructured' ;;
      --colormap) words='viridis cividis coolwarm grey' ;;
      --format | --from) words='msh22_ascii msh22_binary msh41_ascii msh41_binary vtu native' ;;
    esac
  fi
  if [[ -n $words ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
  else
    mapfile -t COMPREPLY < <(compgen -f -- "$word")
    compopt -o filenames 2>/dev/null
  fi
}
complete -F _bezel bezel
