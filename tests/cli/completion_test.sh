#!/usr/bin/env bash
# usage: completion_test.sh BEZEL BEZEL.BASH: what bash completes for given words.
set -eu
bezel=$1
source "$2"
failed=0
expect() {  # expect "COMPLETIONS" WORD…: the last word is the one being completed
  local expected=$1
  shift
  COMP_WORDS=("$bezel" "$@")
  COMP_CWORD=$#
  COMPREPLY=()
  _bezel
  if [ "${COMPREPLY[*]}" != "$expected" ]; then
    echo "completing '$*': found '${COMPREPLY[*]}', expected '$expected'" >&2
    failed=1
  fi
}
expect "transfer" tr
expect "mesh" m
expect "disc" mesh di
expect "--uncovered" transfer a b --unc
expect "error extend" transfer a b --uncovered e
expect "--json" info --js
expect "eval" ev
expect "roots" ro
expect "compensated" study co
expect "newton" study n
expect "certified" eval p.json --precision c
expect "full" roots p.json --newton f
expect "--max-iterations" roots --max
expect "intersect" int
expect "--coincidence-distance" intersect curves.json --coi
expect "--control-polygons" intersect curves.json --control
exit $failed
