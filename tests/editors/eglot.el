;; What a reader of Emacs asks, written as JSON to the file that REPORT names.

(require 'eglot)
(require 'json)

(defun try-until (what condition)
  "Wait until CONDITION returns something true; WHAT completes the sentence of the error."
  (let ((end (+ (float-time) 30)) found)
    (while (not (setq found (funcall condition)))
      (when (> (float-time) end) (error "waited in vain until %s" what))
      (accept-process-output nil 0.05))
    found))

(defun try-mistakes ()
  "Return the mistakes that Flymake knows, as line and text."
  (mapcar (lambda (item)
            (list (line-number-at-pos (flymake-diagnostic-beg item)) (flymake-diagnostic-text item)))
          (flymake-diagnostics)))

(let (report)
  (condition-case fault
      (progn
        (find-file (getenv "PROGRAM"))
        (push (cons 'mode (symbol-name major-mode)) report)
        (apply #'eglot--connect (eglot--guess-contact))
        (try-until "eglot manages the buffer" (lambda () (eglot-managed-p)))
        (try-until "there is a mistake" (lambda () (flymake-start) (try-mistakes)))
        (push (cons 'mistakes (vconcat (mapcar #'vconcat (try-mistakes)))) report)
        (goto-char (point-min))
        (search-forward "MOV     sum")
        (backward-char)
        (push (cons 'references (length (xref-backend-references (xref-find-backend) "sum"))) report)
        (eglot-rename "total")
        (goto-char (point-min))
        (search-forward "ADDD")
        (replace-match "ADD ")
        (goto-char (point-min))
        (eglot--signal-textDocument/didChange)
        (eglot-format-buffer)
        (try-until "there is no mistake" (lambda () (flymake-start) (not (try-mistakes))))
        (push (cons 'text (buffer-substring-no-properties (point-min) (point-max))) report)
        (set-buffer-modified-p nil)
        (eglot-shutdown (eglot-current-server)))
    (error (push (cons 'fault (error-message-string fault)) report)))
  (with-temp-file (getenv "REPORT") (insert (json-encode report))))
