"""A copy of the sources, for tests that change them."""
import shutil
import subprocess


def files(root):
    """What git has, or would take. A release has no git: then everything but what is built."""
    if not (root / ".git").exists():
        tops = [entry for entry in root.iterdir() if entry.name != "build"]
        return [path.relative_to(root) for top in tops for path in (top, *top.rglob("*")) if not path.is_dir() or path.is_symlink()]
    # The folder is named, so that git works in one of another user, too.
    listed = subprocess.run(["git", f"--git-dir={root / '.git'}", "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                            cwd=root, check=True, stdout=subprocess.PIPE, text=True).stdout
    return [name for name in listed.split("\0") if name and (root / name).exists()]


def copy_tree(root, copy):
    """What `copy` has built stays."""
    copy.mkdir(parents=True, exist_ok=True)
    for entry in copy.iterdir():
        if entry.name != "build":
            shutil.rmtree(entry) if entry.is_dir() and not entry.is_symlink() else entry.unlink()
    for name in files(root):
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(root / name, copy / name, follow_symlinks=False)
